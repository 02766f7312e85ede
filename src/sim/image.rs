//! Depth images: every pixel of an array, simulated by itself.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::error::{Result, poll_stop};
use crate::note::{Note, merged};

use super::callback::{Callback, call};
use super::fast::histogram::Histograms;
use super::frames::Frame;
use super::run::{Observers, Run};
use super::setup::Setup;
use super::setup::array::ArraySetup;
use super::shot_recorder::Shot;

mod fidelity;
mod live_images;
mod pixel_frame;

pub use fidelity::ImageFidelity;
pub use live_images::LiveImages;
pub use pixel_frame::{Expected, PixelFrame};

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
            let pixel = simulate(&setup, fidelity, count, None, stop)?;
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

/// Simulates the frames of a pixel. `shots` receives each of their shots, in order, where shots are simulated.
///
/// # Errors
/// When the fidelity does not apply, a frame never ends, `shots` fails, or it is stopped.
pub fn simulate(
    setup: &Setup,
    fidelity: ImageFidelity,
    count: u64,
    mut shots: Option<Callback<Shot>>,
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
            let wants_shots = shots.is_some();
            let mut take_shot = |shot: &Shot| call(&mut shots, shot);
            let observers = Observers {
                frames: Some(&mut take),
                shots: wants_shots.then_some(&mut take_shot),
                stop,
                ..Observers::default()
            };
            Run::new(setup).stepping(stepping).observe(count, observers)?;
        }
    }
    Ok(Pixel { expected: Expected::of(setup), frames, notes: setup.notes()? })
}

#[cfg(test)]
mod tests;
