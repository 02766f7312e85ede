//! A pixel of an array, on the command line.

use std::str::FromStr;

use tofsim::error::{Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

/// Row and column of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelPlace([usize; 2]);

impl FromStr for PixelPlace {
    type Err = &'static str;

    fn from_str(given: &str) -> std::result::Result<Self, Self::Err> {
        let numbers = given.split_once(',').and_then(|(row, column)| {
            Some([row.trim().parse().ok()?, column.trim().parse().ok()?])
        });
        numbers.map(PixelPlace).ok_or("expected a row and a column from 0, such as 20,15")
    }
}

impl PixelPlace {
    /// Returns row and column.
    ///
    /// # Errors
    /// When the array has no such pixel.
    pub fn within(self, array: &ArraySetup) -> Result<[usize; 2]> {
        let (PixelPlace([row, column]), [rows, columns]) = (self, array.size());
        if row < rows && column < columns {
            return Ok([row, column]);
        }
        let expected = format!(
            "expected rows 0 to {} and columns 0 to {} (array.rows, array.columns)",
            rows - 1,
            columns - 1
        );
        Err(Input::new("--pixel", expected).value(format!("{row},{column}")).into())
    }

    /// Elaborates a scenario, and returns the setup of the pixel.
    ///
    /// # Errors
    /// When the array has no such pixel, or the scenario cannot be elaborated.
    pub fn setup(self, loaded: Loaded) -> Result<Setup> {
        let array = ArraySetup::new(loaded)?;
        let [row, column] = self.within(&array)?;
        Ok(array.pixel(row, column))
    }
}

/// Elaborates a scenario for histograms without depths; of an array, what its pixels have in common.
///
/// # Errors
/// When the scenario cannot be elaborated.
pub fn common_of_counts(loaded: Loaded) -> Result<Setup> {
    Ok(columns_of_counts(loaded)?.0)
}

/// Elaborates the same, and besides what the pixels of each column have in common, as [`ArraySetup::columns`] does.
///
/// # Errors
/// As [`common_of_counts`].
pub fn columns_of_counts(loaded: Loaded) -> Result<(Setup, Vec<Setup>)> {
    if loaded.scenario.array.count() > 1 {
        let array = ArraySetup::of_counts(loaded)?;
        return Ok((array.common().clone(), array.columns()));
    }
    let setup = Setup::of_counts(loaded)?;
    Ok((setup.clone(), vec![setup]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_a_row_and_a_column() {
        assert_eq!("20,15".parse(), Ok(PixelPlace([20, 15])));
        for wrong in ["", "3", "3,", "-1,0", "3,4,5", "a,b", "1.5,0"] {
            assert!(wrong.parse::<PixelPlace>().is_err(), "{wrong}");
        }
    }
}
