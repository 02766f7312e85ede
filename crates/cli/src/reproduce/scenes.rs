//! Single histograms of stated scenes, and what peak detection sees in them.

use tofsim::error::Result;
use tofsim::network::Histogram;
use tofsim::optics::BinProbabilities;
use tofsim_learn::dataset::{HistogramSource, Scene};
use tofsim_learn::estimation::findpeaks::Peak;
use tofsim_learn::estimation::peak_detection::PeakDetection;

use crate::page::plot::{BLUE, GREY, Layer, ORANGE, Shape};

use super::peaks::{Peaks, SHOTS};
use super::study::Study;

/// Width of a bin [ns].
pub const BIN_NS: f64 = 0.025;

/// A scene, and what a shot of it can give.
pub struct View {
    pub scene: Scene,
    source: HistogramSource,
    pub codes: BinProbabilities,
}

impl View {
    /// Of a distance [m], a reflectance [1] and an irradiance [W/m^2/nm].
    ///
    /// # Errors
    /// When the thesis's instrument cannot be made.
    pub fn new(study: &Study, distance_m: f64, reflectance: f64, irradiance: f64) -> Result<Self> {
        let source = study.source()?;
        let scene =
            Scene { distance_m, reflectance, irradiance_w_m2_nm: irradiance, setting: 0, pixel: 0 };
        let codes = source.probabilities(&scene);
        Ok(View { scene, source, codes })
    }

    /// Returns the bin probabilities of a shot with the laser off.
    pub fn dark(&self) -> BinProbabilities {
        self.source.probabilities_with(&self.source.white(&self.scene), &self.scene, false)
    }

    /// Signal per shot [1], and rate of ambient avalanches [1/s].
    pub fn light(&self) -> (f64, f64) {
        let white = self.source.white(&self.scene);
        let Scene { reflectance, irradiance_w_m2_nm, .. } = self.scene;
        let ambient = white.ambient_rate_hz * reflectance * irradiance_w_m2_nm;
        (white.signal_per_shot * reflectance, ambient)
    }

    /// The histogram of a frame; each number is another.
    pub fn histogram(&self, study: &Study, number: u64) -> Histogram {
        study.draw(&self.source, &self.codes, number)
    }
}

/// Counts in double precision.
pub fn counts(histogram: &[u32]) -> Vec<f64> {
    histogram.iter().copied().map(f64::from).collect()
}

/// Mean counts of the bins from one time to another [hits].
pub fn mean(counts: &[f64], from_ns: f64, until_ns: f64) -> f64 {
    let bin = |ns: f64| ((ns / BIN_NS) as usize).min(counts.len());
    let part = &counts[bin(from_ns)..bin(until_ns)];
    part.iter().sum::<f64>() / part.len().max(1) as f64
}

/// The counts as bars over time.
pub fn bars(counts: &[f64]) -> Layer {
    let points = counts.iter().enumerate().map(|(bin, count)| (bin as f64 * BIN_NS, *count));
    let end = (counts.len() as f64 * BIN_NS, 0.0);
    Layer::new("histogram", GREY, Shape::Bars, points.chain([end]))
}

/// The largest count [hits].
pub fn height(counts: &[f64]) -> f64 {
    counts.iter().copied().fold(0.0, f64::max)
}

/// An upright line where the echo of a target arrives, as high as the histogram.
pub fn target(distance_m: f64, counts: &[f64]) -> Layer {
    let ns = 1e-3 * Peaks::arrival_ps(distance_m);
    let ends = [(ns, 0.0), (ns, height(counts))];
    Layer::between(format!("target: {ns:.3} ns"), ORANGE, ends)
}

/// The smoothed curve of Listing 5.1.
pub fn curve(detection: &PeakDetection, counts: &[f64]) -> Layer {
    let (x, y) = detection.curve(counts).unwrap_or_default();
    let points = x.iter().zip(y).map(|(x, y)| (x * 1e-3, y));
    Layer::new("smoothed on 100 points (Listing 5.1)", BLUE, Shape::Line, points)
}

/// Width at half height and prominence of a peak (Listing 5.2, Fig. 5.2).
pub fn features(peak: &Peak, detection: &PeakDetection, counts: &[f64]) -> [Layer; 2] {
    let (x, y) = detection.curve(counts).unwrap_or_default();
    let (at, half) = (peak.location * 1e-3, peak.height / 2.0);
    let left = (0..peak.index)
        .rev()
        .find(|&k| y[k] <= half)
        .map_or(x[0], |k| x[k] + (x[k + 1] - x[k]) * (half - y[k]) / (y[k + 1] - y[k]));
    let width = format!("width at half height: {:.0} ps", peak.width);
    let prominence = format!("prominence: {:.0} hits", peak.prominence);
    let ends = [(left * 1e-3, half), ((left + peak.width) * 1e-3, half)];
    let heights = [(at, peak.height - peak.prominence), (at, peak.height)];
    [
        Layer::new(width, RED_BROWN, Shape::Line, ends),
        Layer::new(prominence, GREEN, Shape::Line, heights),
    ]
}

const RED_BROWN: plotters::style::RGBColor = plotters::style::RGBColor(176, 58, 46);
const GREEN: plotters::style::RGBColor = plotters::style::RGBColor(47, 133, 90);

/// The detector of the thesis, with its constants.
pub fn detection() -> PeakDetection {
    PeakDetection::new(SHOTS)
}
