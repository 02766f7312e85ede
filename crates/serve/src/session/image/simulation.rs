//! Simulates images of one scenario after another.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use tofsim::error::{Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::image::{Expected, ImageFidelity, LiveImages, PixelFrame};
use tofsim::sim::setup::array::ArraySetup;

use crate::served::notes_of_array;

/// A simulated image.
pub struct Image {
    /// Its number, from 0.
    pub number: u64,
    /// Hash of its scenario.
    pub hash: Arc<str>,
    /// What the frames of each pixel can be expected to hold, by row, then column.
    pub expected: Arc<[Expected]>,
    /// The frame of each pixel.
    pub frames: Vec<PixelFrame>,
    /// Notes on its depths.
    pub notes: Arc<[String]>,
}

/// Flags that stop a task.
#[derive(Clone, Debug, Default)]
pub struct Stops {
    /// Stops the image, which goes on from there in the next task.
    pub image: Arc<AtomicBool>,
    /// Stops the elaboration of the pixels, which begins again.
    pub elaboration: Arc<AtomicBool>,
}

/// The images of a scenario, which may be followed by another.
pub struct Simulation {
    fidelity: ImageFidelity,
    loaded: Option<Loaded>,
    /// Elaborated pixels of the scenario.
    array: Option<Array>,
    simulated: Arc<AtomicU64>,
}

struct Array {
    images: LiveImages,
    hash: Arc<str>,
    expected: Arc<[Expected]>,
    notes: Arc<[String]>,
}

impl Simulation {
    /// Creates a simulation without a scenario; `simulated` counts the pixels of the present image.
    pub fn new(fidelity: ImageFidelity, simulated: Arc<AtomicU64>) -> Self {
        Simulation { fidelity, loaded: None, array: None, simulated }
    }

    /// Simulates the next image, or the first one of a scenario.
    ///
    /// # Errors
    /// If the scenario cannot be simulated, or it is stopped.
    pub fn image(&mut self, begin: Option<Loaded>, stops: &Stops) -> Result<Image> {
        if begin.is_some() {
            (self.loaded, self.array) = (begin, None);
            self.simulated.store(0, Ordering::Relaxed);
        }
        self.next_image(stops)
    }

    fn next_image(&mut self, stops: &Stops) -> Result<Image> {
        let array = match (&mut self.array, &self.loaded) {
            (Some(array), _) => array,
            (none, Some(loaded)) => {
                none.insert(Array::new(loaded, self.fidelity, &stops.elaboration)?)
            }
            (None, None) => return Err(Input::new("simulation", "expected a scenario").into()),
        };
        let number = array.images.done();
        let simulated = || _ = self.simulated.fetch_add(1, Ordering::Relaxed);
        let frames = array.images.next_image(Some(&stops.image), &simulated)?;
        self.simulated.store(0, Ordering::Relaxed);
        let Array { hash, expected, notes, .. } = array;
        let (hash, expected, notes) = (Arc::clone(hash), Arc::clone(expected), Arc::clone(notes));
        Ok(Image { number, hash, expected, frames, notes })
    }
}

impl Array {
    fn new(loaded: &Loaded, fidelity: ImageFidelity, stop: &AtomicBool) -> Result<Self> {
        let array = ArraySetup::new(loaded.clone())?;
        let images = LiveImages::new(&array, fidelity, Some(stop))?;
        let notes = notes_of_array(array.common(), images.notes());
        Ok(Array {
            hash: array.common().hash().into(),
            expected: images.expected().into(),
            notes: notes.iter().map(ToString::to_string).collect(),
            images,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::Error;
    use tofsim::scenario::load;

    fn loaded(distance_m: f64) -> Loaded {
        let distance = format!("target.distance_m={distance_m}");
        let keys = ["array.rows=2", "array.columns=2", "firmware.shots_per_frame=300"];
        load("kc705", &[&keys.map(str::to_owned)[..], &[distance]].concat()).unwrap()
    }

    #[test]
    fn a_new_scenario_begins_with_image_0_and_a_stop_loses_nothing() {
        let simulated = Arc::new(AtomicU64::new(0));
        let mut simulation = Simulation::new(ImageFidelity::Histograms, Arc::clone(&simulated));
        let mut image = |begin, stops| simulation.image(begin, &stops);
        let [stopped, abandoned] = [Stops::default(), Stops::default()];
        stopped.image.store(true, Ordering::Relaxed);
        abandoned.elaboration.store(true, Ordering::Relaxed);

        let found = image(Some(loaded(0.3)), abandoned);
        assert!(matches!(found, Err(Error::Interrupted)));
        let found = image(None, stopped.clone());
        assert!(matches!(found, Err(Error::Interrupted)));
        let near = image(None, Stops::default()).unwrap();
        assert!(matches!(image(None, stopped), Err(Error::Interrupted)));
        let next = image(None, Stops::default()).unwrap();
        let far = image(Some(loaded(0.5)), Stops::default()).unwrap();
        assert_eq!([near.number, next.number, far.number], [0, 1, 0]);
        assert!(near.frames != next.frames && near.expected == next.expected);
        let radial_m = |image: &Image| image.expected[0].radial_m.unwrap();
        assert!(radial_m(&near) < 0.35 && radial_m(&far) > 0.45);
        assert!(near.hash == next.hash && near.hash != far.hash);
    }
}
