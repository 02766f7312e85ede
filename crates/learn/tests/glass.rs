//! A cover window's light: its calibration, estimates beside it and their bound, under fixed seeds.
//!
//! Histograms are drawn here shot by shot's probabilities that are computed from the formula alone, without the
//! simulator's optics.

mod bound;
mod calibration;
mod estimators;
mod firmware;

use rand::Rng;
use rand_distr::{Binomial, Distribution};

use tofsim::Setup;
use tofsim::kernel::pulse::{Pulse, normal_cdf};
use tofsim::network::Histogram;
use tofsim::optics::Bins;
use tofsim::scenario::glass::GlassTemplate;
use tofsim_learn::calibration::glass::GlassCalibration;
use tofsim_learn::estimation::Acquisition;
use tofsim_learn::estimation::acquisition::ARRIVAL_PS_PER_M;

/// Shots of a frame [shots].
const SHOTS: u64 = 30_000;
/// Standard deviation of the pulse [ps].
const SIGMA_PS: f64 = 137.0;
const PULSE: Pulse = Pulse::Gaussian { sigma_ps: SIGMA_PS };
/// Delay of the window's light [ps], and its standard deviation: the pulse's and its own.
const GLASS_PS: f64 = 180.0;
const GLASS_SIGMA_PS: f64 = 150.0;
/// Ambient light and dark counts [1/ps].
const AMBIENT: f64 = 1e-5;

/// Mean photons of each kind in a shot.
#[derive(Clone, Copy, Debug)]
struct Light {
    /// Of the cover window.
    glass: f64,
    /// Of the target.
    signal: f64,
    /// Where the target is [m].
    distance_m: f64,
    /// Of a second target, and where it is [m].
    second: (f64, f64),
}

impl Light {
    const DARK: Light = Light { glass: 0.0, signal: 0.0, distance_m: 1.0, second: (0.0, 1.0) };

    /// Mean photons from the laser edge to a time.
    fn until(&self, t_ps: f64) -> f64 {
        if t_ps <= 0.0 {
            return 0.0;
        }
        let echo = |(signal, distance_m): (f64, f64)| {
            signal * normal_cdf((t_ps - distance_m * ARRIVAL_PS_PER_M) / SIGMA_PS)
        };
        let glass = self.glass * normal_cdf((t_ps - GLASS_PS) / GLASS_SIGMA_PS);
        AMBIENT * t_ps + glass + echo((self.signal, self.distance_m)) + echo(self.second)
    }

    /// Probability of each code in a shot.
    fn probabilities(&self, bins: &Bins) -> Vec<f64> {
        let mut codes = vec![0.0; bins.count()];
        for span in bins.spans() {
            let [from, until] =
                [span.from, span.until].map(|time| self.until(time.fs() as f64 * 1e-3));
            codes[span.code as usize] += (-from).exp() - (-until).exp();
        }
        codes
    }

    /// Histograms of so many frames.
    fn drawn(&self, bins: &Bins, frames: usize, seed: u64) -> Vec<Histogram> {
        let probabilities = self.probabilities(bins);
        let mut random = random(seed);
        (0..frames).map(|_| drawn(&probabilities, &mut random)).collect()
    }
}

fn random(seed: u64) -> impl Rng {
    tofsim::sensor::streams::stream(seed, tofsim::sensor::streams::Source::Histogram, 46)
}

fn drawn(probabilities: &[f64], random: &mut impl Rng) -> Histogram {
    let (mut left, mut rest) = (SHOTS, 1.0);
    let count = |&p: &f64| {
        let of_rest = if rest > 0.0 { (p / rest).clamp(0.0, 1.0) } else { 0.0 };
        let count = Binomial::new(left, of_rest).unwrap().sample(random);
        (left, rest) = (left - count, rest - p);
        count as u32
    };
    probabilities.iter().map(count).collect()
}

fn bins(profile: &str) -> Bins {
    Setup::load("kc705", &[&format!("tdc.profile={profile}")]).unwrap().bins()
}

fn acquisition<'a>(bins: &'a Bins, glass: Option<&'a GlassTemplate>) -> Acquisition<'a> {
    Acquisition { glass, ..Acquisition::new(bins, SHOTS, &PULSE) }
}

fn calibrated(bins: &Bins, histograms: &[Histogram]) -> Result<GlassCalibration, String> {
    let name = |number| ("mine.npy".to_owned(), number);
    let found = GlassCalibration::new(&acquisition(bins, None), histograms, name);
    found.map_err(|error| error.to_string())
}
