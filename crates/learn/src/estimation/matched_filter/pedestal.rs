//! A cover window's light beside an echo in the matched filter.
//!
//! Its amplitude is a third unknown of the least squares: the template without its flat part is one more shape to which
//! a pulse is made orthogonal. Its bins weigh less in the measure in which their hazard, and so their variance, is above
//! the others', or noise of a strong pedestal would stand out more than an echo.

use tofsim::scenario::glass::GlassTemplate;

use crate::estimation::coates::Corrected;

/// A template by bins in order of time.
#[derive(Clone, Debug)]
pub struct Glass(Vec<f64>);

/// A template without its flat part, in weighed bins.
pub struct Projected {
    /// By bin in order of time [1].
    pub shape: Vec<f64>,
    /// Fraction of the flat shape in the template [1].
    pub flat_part: f64,
    /// Weighted squares of the shape.
    pub squares: f64,
    /// Weighted shape times hazards.
    pub product: f64,
}

impl Glass {
    /// The hazards of a template in the order of `codes`.
    pub fn new(glass: &GlassTemplate, codes: impl Iterator<Item = u16>) -> Self {
        Glass(codes.map(|code| glass.bins()[code as usize].hazard).collect())
    }

    /// Lowers the weights of bins where the window's light is, by its amplitude in their hazards.
    pub fn weigh(&self, bins: &mut [Corrected]) {
        let (mut inside, mut template, mut outside, mut count) = (0.0, 0.0, 0.0, 0.0f64);
        for (bin, &own) in bins.iter().zip(&self.0).filter(|(bin, _)| bin.waiting > 0.0) {
            if own > 0.0 {
                (inside, template) = (inside + bin.hazard, template + own);
            } else {
                (outside, count) = (outside + bin.hazard, count + 1.0);
            }
        }
        let amplitude = if template > 0.0 { inside / template } else { 0.0 };
        let most = bins.first().map_or(1.0, |bin| bin.waiting.max(1.0));
        let level = (outside / count.max(1.0)).max(1.0 / most);
        for (bin, own) in bins.iter_mut().zip(&self.0) {
            bin.waiting *= level / (level + amplitude * own);
        }
    }

    /// The template without its flat part, where `flat` has the weighted squares of the widths.
    pub fn projected(&self, bins: &[Corrected], widths: &[f64], flat: [f64; 2]) -> Projected {
        let terms = || self.0.iter().zip(widths).zip(bins);
        let with_flat: f64 = terms().map(|((own, width), bin)| bin.waiting * own * width).sum();
        let flat_part = if flat[0] > 0.0 { with_flat / flat[0] } else { 0.0 };
        let shape: Vec<_> = terms().map(|((own, width), _)| own - flat_part * width).collect();
        let weighed = || shape.iter().zip(bins).map(|(own, bin)| (bin.waiting * own, own, bin));
        let squares: f64 = weighed().map(|(weighed, own, _)| weighed * own).sum();
        let product = weighed().map(|(weighed, _, bin)| weighed * bin.hazard).sum();
        Projected { squares: squares.max(f64::MIN_POSITIVE), product, flat_part, shape }
    }
}

impl Projected {
    /// Returns the weighted product of the shape with the parts of a pulse from a bin on.
    pub fn within(&self, first: usize, parts: &[f64], bins: &[Corrected]) -> f64 {
        let there = bins[first..].iter().zip(&self.shape[first..]);
        parts.iter().zip(there).map(|(part, (bin, own))| bin.waiting * part * own).sum()
    }
}
