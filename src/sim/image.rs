//! Depth images: every pixel of an array, simulated by itself.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::error::{Result, poll_stop};
use crate::firmware::tof_top::status::StatusSet;
use crate::note::{Note, merged};

use super::fast::histogram::Histograms;
use super::frames::Frame;
use super::run::{Observers, Run};
use super::setup::Setup;
use super::setup::array::ArraySetup;
use super::stepping::Stepping;

mod live_images;

pub use live_images::LiveImages;

/// Simulation fidelity of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFidelity {
    /// Shots are simulated.
    Shots(Stepping),
    /// Histograms are drawn from their distribution.
    Histograms,
}

/// A pixel of some images.
#[derive(Clone, Debug)]
pub struct Pixel {
    /// What its frames can be expected to hold.
    pub expected: Expected,
    /// Its frame in each image.
    pub frames: Vec<PixelFrame>,
    /// Notes on depths outside of the model's validity.
    pub notes: Vec<Note>,
}

/// What the frames of a pixel can be expected to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Mean distance of what returns the pixel's light, along the line of sight; `None` if nothing does [m].
    pub radial_m: Option<f64>,
    /// Hits of laser photons in the histogram; `None` where shots depend on each other [1].
    pub signal_hits: Option<f64>,
    /// Other hits in the histogram; `None` where shots depend on each other [1].
    pub ambient_hits: Option<f64>,
}

/// Result of a pixel in one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFrame {
    /// Estimated distance along the line of sight [m].
    pub radial_m: f64,
    /// Its standard deviation, from an estimator that states one [m].
    pub sigma_m: Option<f64>,
    /// Whether the status has no reason to reject the distance.
    pub valid: bool,
    /// Reasons to reject it.
    pub status: StatusSet,
    /// Hits in the histogram.
    pub hits: u64,
}

impl PixelFrame {
    fn of(frame: &Frame) -> Self {
        let estimate = frame.estimate();
        PixelFrame {
            radial_m: frame.depth_m(),
            sigma_m: estimate.sigma_m,
            valid: estimate.valid,
            status: estimate.status,
            hits: frame.hits(),
        }
    }
}

impl Expected {
    fn of(setup: &Setup) -> Self {
        let radial_m = setup.mean_radial_m();
        let (chances, shots) = (setup.chances(), setup.shots(1) as f64);
        let signal = chances.map(|chances| chances.counted_signal);
        let ambient = chances.map(|chances| (chances.counted - chances.counted_signal).max(0.0));
        let [signal_hits, ambient_hits] = [signal, ambient].map(|hits| Some(hits? * shots));
        Expected { radial_m, signal_hits, ambient_hits }
    }
}

impl ArraySetup {
    /// Simulates images on all threads of the current pool, and returns their pixels by row, then column. `done` is
    /// called with the number of frames after each pixel. The results are the same for any number of threads, and those
    /// of a pixel are the same alone.
    ///
    /// # Errors
    /// When the fidelity does not apply, a frame never ends, or it is stopped.
    pub fn images(
        &self,
        fidelity: ImageFidelity,
        count: u64,
        stop: Option<&AtomicBool>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<Pixel>> {
        let [rows, columns] = self.size();
        let pixel = |place: usize| {
            poll_stop(stop)?;
            let setup = self.pixel(place / columns, place % columns);
            let pixel = simulate(&setup, fidelity, count, stop)?;
            done(count);
            Ok(pixel)
        };
        (0..rows * columns).into_par_iter().map(pixel).collect()
    }

    /// Returns the notes of all pixels on depths outside of the model's validity, each cause once.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        let [rows, columns] = self.size();
        let notes = |place: usize| self.pixel(place / columns, place % columns).notes();
        let notes: Vec<_> =
            (0..rows * columns).into_par_iter().map(notes).collect::<Result<_>>()?;
        Ok(merged(notes.iter().map(|notes| &notes[..])))
    }
}

/// Returns the least of some numbers, their median, and the largest.
pub fn ends_and_median(values: impl Iterator<Item = f64>) -> Option<[f64; 3]> {
    let mut sorted: Vec<_> = values.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (&least, &most) = (sorted.first()?, sorted.last()?);
    let half = sorted.len() / 2;
    let median = (sorted[half] + sorted[sorted.len() - 1 - half]) / 2.0;
    Some([least, median, most])
}

/// Simulates the frames of a pixel.
///
/// # Errors
/// When the fidelity does not apply, a frame never ends, or it is stopped.
pub fn simulate(
    setup: &Setup,
    fidelity: ImageFidelity,
    count: u64,
    stop: Option<&AtomicBool>,
) -> Result<Pixel> {
    let mut frames = Vec::new();
    match fidelity {
        ImageFidelity::Histograms => {
            let histograms = Histograms::new(setup)?;
            for index in 0..count {
                poll_stop(stop)?;
                frames.push(PixelFrame::of(&histograms.frame(index)));
            }
        }
        ImageFidelity::Shots(stepping) => {
            let mut take = |frame: &Frame| {
                frames.push(PixelFrame::of(frame));
                Ok(())
            };
            let observers = Observers { frames: Some(&mut take), stop, ..Observers::default() };
            Run::new(setup).stepping(stepping).observe(count, observers)?;
        }
    }
    Ok(Pixel { expected: Expected::of(setup), frames, notes: setup.notes()? })
}

#[cfg(test)]
mod tests;
