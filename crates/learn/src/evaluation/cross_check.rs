//! The fast path beside the simulation of every cycle, at a sample of points.
//!
//! An evaluation draws histograms from probabilities and estimates with integer sums. Here frames
//! go through the whole firmware: their histograms have to have those probabilities, and their
//! depths have to be those of the sums, bit for bit.

use std::sync::atomic::AtomicBool;

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::error::Result;
use tofsim::scenario::Loaded;
use tofsim::sim::Run;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;

use crate::dataset::{HistogramSource, Scene};

/// Chance below which counts are taken for others than those drawn.
const LEVEL: f64 = 1e-6;
/// Hits that a cell of the test has to expect, or it is joined to the next.
const CELL: f64 = 20.0;

/// Result of the frames of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossCheck {
    /// Distance of the target [m].
    pub distance_m: f64,
    /// Row and column of the pixel, of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel: Option<[usize; 2]>,
    /// Frames simulated, cycle by cycle.
    pub frames: u64,
    /// Frames whose depth word is not that of the integer sums.
    pub other_depths: u64,
    /// Chance of a chi-square as large as that of the counts, if they have the probabilities.
    pub p_value: f64,
}

impl CrossCheck {
    /// Whether both paths are the same.
    pub fn agrees(&self) -> bool {
        self.other_depths == 0 && self.p_value > LEVEL
    }

    /// Simulates frames of a scene, all else being as in `loaded`, of which `source` has the scene's
    /// setting.
    ///
    /// # Errors
    /// When the scenario does not run, or it is stopped.
    pub fn new(
        loaded: &Loaded,
        source: &HistogramSource,
        scene: &Scene,
        frames: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<Self> {
        let mut loaded = loaded.clone();
        loaded.scenario.target.distance_m = scene.distance_m;
        loaded.scenario.target.reflectance = scene.reflectance;
        loaded.scenario.ambient.irradiance_w_m2_nm = scene.irradiance_w_m2_nm;
        CrossCheck::of_setup(&Setup::of_counts(loaded)?, source, scene, frames, stop)
    }

    /// The same of a setup with the scene, which may be that of a pixel.
    ///
    /// # Errors
    /// When it does not run, or is stopped.
    pub fn of_setup(
        setup: &Setup,
        source: &HistogramSource,
        scene: &Scene,
        frames: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<Self> {
        let (mut sums, mut other_depths) = (vec![0u64; setup.params.histogram.bins], 0);
        let mut take = |frame: &Frame| {
            let same = setup.estimate_words(&frame.histogram).depth;
            other_depths += u64::from(same != frame.words.depth);
            for (sum, &count) in sums.iter_mut().zip(&frame.histogram) {
                *sum += u64::from(count);
            }
            Ok(())
        };
        Run::new(setup)
            .observe(frames, Observers { frames: Some(&mut take), stop, ..Observers::default() })?;
        let shots = (frames * u64::from(source.shots_of(scene))) as f64;
        let p_value = p_value(&sums, source.probabilities(scene).of_code(), shots);
        let distance_m = scene.distance_m;
        Ok(CrossCheck { distance_m, pixel: None, frames, other_depths, p_value })
    }
}

/// Of so many shots; those without a code are a cell too.
fn p_value(sums: &[u64], codes: &[f64], shots: f64) -> f64 {
    let missed = shots - sums.iter().sum::<u64>() as f64;
    let expected_missed = shots * (1.0 - codes.iter().sum::<f64>());
    let cells = sums.iter().zip(codes).map(|(&sum, p)| (sum as f64, shots * p));
    let (mut chi_square, mut count, mut joined) = (0.0, 0.0, (0.0, 0.0));
    for (found, expected) in cells.chain([(missed, expected_missed)]) {
        joined = (joined.0 + found, joined.1 + expected);
        if joined.1 >= CELL {
            chi_square += (joined.0 - joined.1).powi(2) / joined.1;
            (count, joined) = (count + 1.0, (0.0, 0.0));
        }
    }
    let distribution = ChiSquared::new(count - 1.0);
    distribution.map_or(1.0, |distribution| distribution.sf(chi_square))
}
