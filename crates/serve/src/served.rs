//! What is served: a single pixel, or an array of them.

use tofsim::Note;
use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::options::{Fidelity, Options};

/// What is served, as it is at the start.
pub struct Served {
    subject: Subject,
    /// Simulation fidelity.
    pub fidelity: Fidelity,
}

enum Subject {
    Pixel(Box<Setup>),
    Array(Box<ArraySetup>),
}

impl Served {
    /// Loads the scenario of the command line.
    ///
    /// # Errors
    /// If it cannot be simulated, or the fidelity does not apply.
    pub fn of(options: &Options) -> Result<Self> {
        let loaded = options.load(&[])?;
        let fidelity = options.fidelity(&loaded)?;
        let subject = match options.shows_images(&loaded) {
            true => Subject::Array(Box::new(ArraySetup::new(loaded)?)),
            false => Subject::Pixel(Box::new(Setup::new(loaded)?)),
        };
        Ok(Served { subject, fidelity })
    }

    /// Returns the setup: that of the pixel, or what the pixels of the array have in common.
    pub fn setup(&self) -> &Setup {
        match &self.subject {
            Subject::Pixel(setup) => setup,
            Subject::Array(array) => array.common(),
        }
    }

    /// Returns notes on results outside of the model's validity.
    ///
    /// # Errors
    /// If the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        match &self.subject {
            Subject::Pixel(setup) => setup.notes(),
            Subject::Array(array) => Ok(notes_of_array(array.common(), &array.notes()?)),
        }
    }
}

/// Returns the notes on the pixels of an array, and those on its estimator.
pub fn notes_of_array(common: &Setup, of_pixels: &[Note]) -> Vec<Note> {
    [of_pixels, &notes_of_firmware(common)].concat()
}
