//! Images of an array that are simulated one after the other, for as long as their owner likes.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::error::{Error, Result, poll_stop};
use crate::note::{Note, merged};
use crate::sim::fast::histogram::FrameDistribution;
use crate::sim::live::Live;
use crate::sim::setup::Setup;
use crate::sim::setup::array::ArraySetup;

use super::fidelity::ImageFidelity;
use super::pixel_frame::{Expected, PixelFrame};

/// The pixels of an array, ready for their next image. Image `n` is that of [`ArraySetup::images`].
pub struct LiveImages {
    /// What the pixels of each column have in common, as their firmware ([`ArraySetup::columns`]).
    columns: Vec<Setup>,
    pixels: Vec<LivePixel>,
    notes: Vec<Note>,
    done: u64,
}

struct LivePixel {
    expected: Expected,
    frames: PixelFrames,
    /// Its frame in the image that is being simulated.
    frame: Option<PixelFrame>,
}

/// Source of a pixel's frames.
enum PixelFrames {
    Shots(Box<Live>),
    Histograms(FrameDistribution),
}

impl LiveImages {
    /// Elaborates the pixels of an array on all threads of the current pool.
    ///
    /// # Errors
    /// When the fidelity does not apply, or it is stopped.
    pub fn new(
        array: &ArraySetup,
        fidelity: ImageFidelity,
        stop: Option<&AtomicBool>,
    ) -> Result<Self> {
        let [rows, columns] = array.size();
        let pixel = |place: usize| {
            poll_stop(stop)?;
            let setup = array.pixel(place / columns, place % columns);
            Ok((setup.notes()?, LivePixel::new(setup, fidelity)?))
        };
        let pixels: Vec<_> =
            (0..rows * columns).into_par_iter().map(pixel).collect::<Result<_>>()?;
        let notes = merged(pixels.iter().map(|(notes, _)| &notes[..]));
        let pixels = pixels.into_iter().map(|(_, pixel)| pixel).collect();
        Ok(LiveImages { columns: array.columns(), pixels, notes, done: 0 })
    }

    /// Returns what the frames of each pixel can be expected to hold, by row, then column.
    pub fn expected(&self) -> Vec<Expected> {
        self.pixels.iter().map(|pixel| pixel.expected).collect()
    }

    /// Returns the notes of all pixels on depths outside of the model's validity.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Returns the number of images done.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Simulates the next image on all threads of the current pool, and returns its pixels by row, then column. `simulated`
    /// is called after each pixel. An image that is stopped goes on from there at the next call.
    ///
    /// # Errors
    /// When a frame never ends, or it is stopped.
    pub fn next_image(
        &mut self,
        stop: Option<&AtomicBool>,
        simulated: &(dyn Fn() + Sync),
    ) -> Result<Vec<PixelFrame>> {
        let (columns, index) = (&self.columns, self.done);
        self.pixels.par_iter_mut().enumerate().try_for_each(|(place, pixel)| {
            if pixel.frame.is_none() {
                poll_stop(stop)?;
                let column = &columns[place % columns.len()];
                pixel.frame = Some(pixel.frames.simulate(column, index, stop)?);
                simulated();
            }
            Ok::<_, Error>(())
        })?;
        self.done += 1;
        Ok(self.pixels.iter_mut().filter_map(|pixel| pixel.frame.take()).collect())
    }
}

impl LivePixel {
    fn new(setup: Setup, fidelity: ImageFidelity) -> Result<Self> {
        let expected = Expected::of(&setup);
        let frames = match fidelity {
            ImageFidelity::Shots(stepping) => {
                PixelFrames::Shots(Box::new(Live::new(Arc::new(setup), stepping)))
            }
            ImageFidelity::Histograms => PixelFrames::Histograms(FrameDistribution::new(&setup)?),
        };
        Ok(LivePixel { expected, frames, frame: None })
    }
}

impl PixelFrames {
    /// Simulates the frame with such an index, the next one.
    fn simulate(
        &mut self,
        column: &Setup,
        index: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<PixelFrame> {
        let frame = match self {
            PixelFrames::Shots(live) => live.next_frame(stop)?,
            PixelFrames::Histograms(frames) => frames.frame(column, index),
        };
        Ok(PixelFrame::of(&frame))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;
    use crate::sim::Stepping;
    use crate::sim::image::tests::array;

    use ImageFidelity::{Histograms, Shots};

    const FIDELITIES: [ImageFidelity; 4] = [
        Histograms,
        Shots(Stepping::EveryCycle),
        Shots(Stepping::SkipIdle),
        Shots(Stepping::LeapShots),
    ];

    fn nothing() {}

    #[test]
    fn each_image_is_that_of_a_run_of_several() {
        let own = ["tdc.profile=kintex7", "array.chains_file=../chains/columns.csv"];
        let likelihood = [&own[..], &["estimator.kind=likelihood"]].concat();
        let setups = [array(&[]), array(&likelihood)];
        let crosstalk = array(&["spad.crosstalk_probability=0.3"]);
        let cases = setups.iter().flat_map(|array| FIDELITIES.map(|fidelity| (array, fidelity)));
        let cases = cases.chain(FIDELITIES[1..].iter().map(|fidelity| (&crosstalk, *fidelity)));
        for (array, fidelity) in cases {
            let all = array.images(fidelity, 4, None, &|_| ()).unwrap();
            let mut images = LiveImages::new(array, fidelity, None).unwrap();
            let expected: Vec<_> = all.iter().map(|pixel| pixel.expected).collect();
            assert_eq!(images.expected(), expected);
            for index in 0..4 {
                let found = images.next_image(None, &nothing).unwrap();
                let image: Vec<_> = all.iter().map(|pixel| pixel.frames[index]).collect();
                assert_eq!(found, image, "{fidelity:?}, image {index}");
            }
            assert_eq!(images.done(), 4);
        }
    }

    #[test]
    fn a_stopped_image_goes_on_where_it_was() {
        // More cycles than between two polls.
        let array = array(&["firmware.shots_per_frame=60000"]);
        for fidelity in [Histograms, Shots(Stepping::SkipIdle)] {
            let image = |images: &mut LiveImages| images.next_image(None, &nothing).unwrap();
            let mut whole = LiveImages::new(&array, fidelity, None).unwrap();
            let mut stopped = LiveImages::new(&array, fidelity, None).unwrap();
            let (stop, count) = (AtomicBool::new(false), AtomicU64::new(0));
            let after_two = || {
                let done = 1 + count.fetch_add(1, Ordering::Relaxed);
                stop.store(done >= 2, Ordering::Relaxed);
            };
            let found = stopped.next_image(Some(&stop), &after_two);
            assert!(matches!(found, Err(Error::Interrupted)), "{fidelity:?}");
            assert!((2..6).contains(&count.into_inner()), "{fidelity:?}");
            assert_eq!(stopped.done(), 0);
            for _ in 0..2 {
                assert_eq!(image(&mut stopped), image(&mut whole), "{fidelity:?}");
            }
        }
    }

    #[test]
    fn a_frame_that_never_ends_and_a_fidelity_that_does_not_apply_are_named() {
        let held = array(&["firmware.dsp_en=false"]);
        let mut images = LiveImages::new(&held, Shots(Stepping::LeapShots), None).unwrap();
        let fault = images.next_image(None, &nothing).unwrap_err().to_string();
        assert!(fault.contains("firmware.dsp_en: frame 0 never ends: dsp_en stays low"), "{fault}");
        let fault = LiveImages::new(&array(&["firmware.mode=1"]), Histograms, None).err().unwrap();
        assert!(fault.to_string().contains("firmware.mode"), "{fault}");
    }
}
