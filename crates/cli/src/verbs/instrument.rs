//! What a scenario describes: a single pixel, or an array with the firmware that scans it.

use tofsim::Note;
use tofsim::error::Result;
use tofsim::scenario::{Array, Loaded};
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

/// An elaborated scenario.
pub struct Instrument {
    /// That of the single pixel; of an array what its pixels have in common, with the firmware that scans them.
    pub setup: Setup,
    /// The array, if there are several pixels or banks.
    pub array: Option<ArraySetup>,
}

impl Instrument {
    /// Elaborates a scenario.
    ///
    /// # Errors
    /// When it cannot be elaborated, or no firmware scans such an array.
    pub fn new(loaded: Loaded) -> Result<Self> {
        let Array { rows, columns, banks, .. } = loaded.scenario.array;
        if [rows, columns] == [1, 1] && banks == 1 {
            return Ok(Instrument { setup: Setup::new(loaded)?, array: None });
        }
        let array = ArraySetup::new(loaded)?;
        Ok(Instrument { setup: array.with_firmware()?, array: Some(array) })
    }

    /// Returns the notes of the pixel, or of all pixels.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        self.array.as_ref().map_or_else(|| self.setup.notes(), ArraySetup::notes)
    }
}
