//! What files say of an array's pixels.

use crate::scenario::dark::Measured;

use super::converter::Converter;

/// What files say of the pixels of an array.
#[derive(Clone, Debug, Default)]
pub struct PixelFiles {
    /// Additional delay of each pixel's signal path; empty if there is none [ps].
    pub offsets_ps: Vec<f64>,
    /// Converters of the columns; empty if all have that of the scenario.
    pub converters: Vec<Converter>,
    /// Dark count rates that were measured.
    pub measured: Option<Measured>,
}
