//! From an instrument to parameters and ROMs.

use std::fmt;
use std::sync::Arc;

use crate::firmware::histogram_builder;
use crate::kernel::pulse::Pulse;
use crate::kernel::sizes::likelihood::{self, EDGE_BITS, WIDTH_BITS};

use super::glass::{Glass, MOST_LIGHT};
use super::pulse::{PulseWord, step_log2, words};
use super::targets::Targets;
pub use super::unfit::Unfit;
use super::words::{DEPTH_FRACTION, LEAST_LEFT_LOG2, UNITS};

/// The box, in deviations of the pulse: the part of a Gaussian in it is 0.84.
const BOX_SIGMA: f64 = 2.8;
/// Bits of the word that turns time into distance.
const METRES_BITS: i32 = 24;

/// Verilog parameters and what is in the ROMs.
#[derive(Clone, PartialEq)]
pub struct Params {
    /// Size of the histogram.
    pub histogram: histogram_builder::Params,
    /// Shots of a histogram.
    pub shots: u64,
    /// Start of each bin, and end of the last one [half units].
    pub edges: Arc<[u32]>,
    /// Those of the other columns of an array, if each has a chain of its own.
    pub columns: Arc<[Arc<[u32]>]>,
    /// End of the last bin of the chain that the rest is computed for [half units].
    pub last_edge: u32,
    /// The pulse, by the time from its middle.
    pub pulse: Arc<[PulseWord]>,
    /// Step of the pulse's ROM is 2 to the power of this [units].
    pub step_log2: u32,
    /// Bins of the fit before the one of the middle.
    pub before: usize,
    /// Bins of the fit after it.
    pub after: usize,
    /// Bins of the box that is slid over the histogram.
    pub box_bins: usize,
    /// 16 times the square of the pulse's deviation, which is 24 to 48 of what z counts.
    pub kappa: i64,
    /// The pulse's deviation [units].
    pub sigma: i64,
    /// Distance of a 16th of a unit, with `metres_shift` more fraction bits than a depth.
    pub metres: i64,
    /// See `metres`.
    pub metres_shift: u32,
    /// Distance that light would go, there and back, in the laser's delay [2^-29 m].
    pub delay: i64,
    /// The cover glass's light.
    pub glass: Glass,
    /// Targets that are found, and which comes first.
    pub targets: Targets,
}

/// Numbers that times and distances are reckoned with, as words or without rounding.
#[derive(Clone, Copy, Debug)]
pub struct Scales<T> {
    /// 16 times the square of the pulse's deviation, which is 24 to 48 of what z counts.
    pub kappa: T,
    /// What a step in mu is multiplied with [2^-17 units / 16].
    pub stride: T,
    /// The pulse's deviation [units].
    pub sigma: T,
    /// Distance of a 16th of a unit, with `metres_shift` more fraction bits than a depth.
    pub metres: T,
    /// Additional fraction bits of `metres`.
    pub metres_shift: u32,
    /// Distance that light would go, there and back, in the laser's delay [2^-29 m].
    pub delay: T,
    /// End of the last bin [units / 16].
    pub end: T,
}

/// Properties of an instrument that the estimator uses.
#[derive(Clone, Debug)]
pub struct Wanted<'a> {
    /// Size of the histogram.
    pub histogram: histogram_builder::Params,
    /// Shots of a histogram.
    pub shots: u64,
    /// Start of each bin, and end of the last one, from the laser edge [ps].
    pub edges_ps: &'a [f64],
    /// Nominal bin width [ps].
    pub bin_ps: f64,
    /// Distribution of the arrivals of an echo.
    pub pulse: Pulse,
    /// Distance for each time of flight, c / 2 [m/ps].
    pub metres_per_ps: f64,
    /// Delay of the light after the laser edge [ps].
    pub delay_ps: f64,
    /// Hazard of a cover glass's light in each bin; empty without one [1].
    pub glass: &'a [f64],
    /// Targets that are found, and which comes first.
    pub targets: Targets,
}

/// Without the ROMs, which follow from the rest and the chain.
impl fmt::Debug for Params {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Params {
            histogram,
            shots,
            step_log2,
            before,
            after,
            box_bins,
            kappa,
            sigma,
            metres,
            delay,
            glass,
            targets,
            ..
        } = self;
        let words = (step_log2, before, after, box_bins, kappa, sigma, metres, delay);
        let mut all = out.debug_struct("Params");
        all.field("histogram", histogram).field("shots", shots).field("words", &words);
        if glass.bins() > 0 {
            all.field("glass", glass);
        }
        if targets.has_second() {
            all.field("targets", targets);
        }
        all.finish()
    }
}

impl Params {
    /// Returns the shots that have to be left at the end of the window for the absence of an echo to show that there is
    /// no target.
    pub fn least_left(&self) -> u64 {
        self.shots >> LEAST_LEFT_LOG2
    }

    /// For a histogram of bins of 25 ps and a pulse as long as one of them: fits into any, and is what an
    /// instrument has that the estimator is not for.
    pub fn stand_in(histogram: histogram_builder::Params) -> Self {
        let bin_ps = 25.0;
        let edges_ps: Vec<_> = (0..=histogram.bins).map(|bin| bin as f64 * bin_ps).collect();
        let (shots, pulse) = (histogram.most_hits(), Pulse::Gaussian { sigma_ps: bin_ps });
        let (metres_per_ps, delay_ps) = (1.5e-4, 0.0);
        let edges_ps = &edges_ps;
        Params::of(&Wanted {
            histogram,
            shots,
            edges_ps,
            bin_ps,
            pulse,
            metres_per_ps,
            delay_ps,
            glass: &[],
            targets: Targets::One,
        })
    }

    /// Returns whether a second target is looked for.
    pub fn has_second(&self) -> bool {
        self.targets.has_second()
    }

    /// Returns whether there may be other light than that of one echo and of ambient light: of a cover glass, or of a
    /// second target.
    pub fn has_more_light(&self) -> bool {
        self.glass.bins() > 0 || self.has_second()
    }

    /// Bits of a word of the solver.
    pub fn word_bits(&self) -> u32 {
        word_bits(&self.histogram)
    }

    /// Bits of a weight.
    pub fn weight_bits(&self) -> u32 {
        likelihood::weight_bits(self.histogram.count_bits)
    }

    /// Bits of an edge in half units.
    pub fn edge_bits(&self) -> u32 {
        self.histogram.bins.ilog2() + EDGE_BITS
    }

    /// 16 times `kappa`'s distance: what a step in mu is multiplied with [2^-17 units / 16].
    pub fn stride(&self) -> i64 {
        self.kappa << self.step_log2
    }

    /// The numbers that times and distances are reckoned with.
    pub fn scales(&self) -> Scales<i64> {
        let Params { kappa, sigma, metres, metres_shift, delay, .. } = *self;
        Scales { kappa, stride: self.stride(), sigma, metres, metres_shift, delay, end: self.end() }
    }

    /// Returns the end of the last bin [units / 16].
    pub fn end(&self) -> i64 {
        i64::from(self.last_edge) << 3
    }

    /// Returns the start of each bin of a column, and the end of the last one [half units].
    pub fn edges_of(&self, column: usize) -> &[u32] {
        column.checked_sub(1).and_then(|other| self.columns.get(other)).unwrap_or(&self.edges)
    }

    /// Returns the parameters for a histogram with other bins.
    pub fn with_edges(self, edges: Arc<[u32]>) -> Self {
        Params { edges, ..self }
    }

    /// Width of a bin [units].
    pub fn width(&self, bin: usize) -> i64 {
        width(&self.edges[bin..]).into()
    }

    /// Bins of a fit, but for the one that stands for all others.
    pub fn fitted(&self) -> usize {
        self.before + 1 + self.after
    }

    /// For an instrument.
    ///
    /// # Errors
    /// When the pulse is too short or too long for the histogram, or the window too long for a depth.
    pub fn new(wanted: &Wanted) -> Result<Self, Unfit> {
        match wanted.fault() {
            Some(unfit) => Err(unfit),
            None => Ok(Params::of(wanted)),
        }
    }

    /// For one that it fits.
    fn of(wanted: &Wanted) -> Self {
        let Wanted { histogram, shots, bin_ps, pulse, .. } = wanted;
        let (scales, step_log2) = (wanted.scales(), wanted.step_log2());
        let [before, after] = wanted.reach();
        Params {
            histogram: *histogram,
            shots: *shots,
            last_edge: wanted.edges()[histogram.bins],
            edges: wanted.edges().into(),
            columns: Arc::default(),
            pulse: words(pulse, wanted.unit_ps(), step_log2).into(),
            step_log2,
            before,
            after,
            box_bins: (libm::round(BOX_SIGMA * pulse.sigma_ps() / bin_ps) as usize)
                .clamp(2, histogram.bins / 2),
            kappa: libm::round(scales.kappa) as i64,
            sigma: libm::round(scales.sigma) as i64,
            metres: libm::round(scales.metres) as i64,
            metres_shift: scales.metres_shift,
            delay: libm::round(scales.delay) as i64,
            glass: Glass::of(wanted.glass),
            targets: wanted.targets,
        }
    }
}

impl Wanted<'_> {
    /// Unit of time [ps].
    pub fn unit_ps(&self) -> f64 {
        self.bin_ps / UNITS as f64
    }

    /// Logarithm of the step of the pulse's ROM [units].
    fn step_log2(&self) -> u32 {
        step_log2(&self.pulse, self.unit_ps())
    }

    /// The numbers that times and distances are reckoned with, without rounding.
    pub fn scales(&self) -> Scales<f64> {
        let (sigma, step) =
            (self.pulse.sigma_ps() / self.unit_ps(), f64::from(1u32 << self.step_log2()));
        let deviation = sigma / step / 4.0;
        let kappa = 16.0 * deviation * deviation;
        let depth_word = f64::from(DEPTH_FRACTION).exp2();
        let distance = self.metres_per_ps * self.unit_ps() / 16.0 * depth_word;
        let metres_shift = (METRES_BITS - 1) - libm::floor(libm::log2(distance)) as i32;
        Scales {
            kappa,
            stride: kappa * step,
            sigma,
            metres: distance * f64::from(metres_shift).exp2(),
            metres_shift: metres_shift as u32,
            delay: self.metres_per_ps * self.delay_ps * depth_word,
            end: self.edges_ps.last().unwrap_or(&0.0) / self.unit_ps() * 16.0,
        }
    }

    /// Edges of the bins [half units].
    fn edges(&self) -> Vec<u32> {
        let half = |ps: &f64| libm::floor(2.0 * ps / self.unit_ps() + 0.5) as u32;
        self.edges_ps.iter().map(half).collect()
    }

    /// Bins of the pulse before and after the one with its middle.
    fn reach(&self) -> [usize; 2] {
        let [begin_ps, end_ps] = self.pulse.ends_ps();
        [-begin_ps, end_ps].map(|ps| libm::floor(ps / self.bin_ps) as usize + 2)
    }

    /// Why there is no estimator for it.
    fn fault(&self) -> Option<Unfit> {
        let (bins, edges) = (self.histogram.bins, self.edges());
        let last = edges.iter().copied().max().unwrap_or(0);
        if last >> (bins.ilog2() + EDGE_BITS) != 0 {
            return Some(Unfit::Late(f64::from(last) / 2.0 / UNITS as f64 - bins as f64));
        }
        let widest = edges.windows(2).map(width).max().unwrap_or(0);
        if widest >= 1 << WIDTH_BITS {
            return Some(Unfit::Wide(f64::from(widest) / UNITS as f64));
        }
        let window_m = self.metres_per_ps * self.unit_ps() * f64::from(last) / 2.0;
        let most_m = f64::from(word_bits(&self.histogram) - 1 - DEPTH_FRACTION).exp2();
        if window_m >= most_m {
            return Some(Unfit::Far(window_m, most_m));
        }
        let light: f64 = self.glass.iter().sum();
        if light > MOST_LIGHT {
            return Some(Unfit::Bright(light, MOST_LIGHT));
        }
        let sigma_ps = self.pulse.sigma_ps();
        if sigma_ps < 0.5 * self.bin_ps {
            return Some(Unfit::Short(sigma_ps / self.bin_ps));
        }
        let long = self.reach().iter().sum::<usize>() + 1;
        (long > bins).then_some(Unfit::Long(long, bins))
    }
}

/// Width of a bin [units] from its edges [half units].
pub fn width(edges: &[u32]) -> u32 {
    edges[1].div_ceil(2) - edges[0].div_ceil(2)
}

/// Bits of a word of the solver for such a histogram.
fn word_bits(histogram: &histogram_builder::Params) -> u32 {
    likelihood::word_bits(histogram.bins.ilog2(), histogram.count_bits)
}
