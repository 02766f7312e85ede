//! What files say of an array's pixels.

use std::sync::Arc;

use crate::scenario::dark::Measured;

use super::converter::Converter;

/// What files say of the pixels of an array.
#[derive(Clone, Debug, Default)]
pub struct PixelFiles {
    /// Additional delay of each pixel's signal path; empty if there is none [ps].
    pub offsets_ps: Vec<f64>,
    /// Fraction of the pulse energy that the cover window sends to each pixel; empty if it is by solid angle [1].
    pub cover_fractions: Vec<f64>,
    /// Parts of the columns; empty if all have those of the scenario.
    pub columns: Vec<Column>,
    /// Dark count rates that were measured.
    pub measured: Option<Measured>,
}

/// What a column of an array has of its own.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its converter.
    pub converter: Converter,
    /// The bins that the likelihood estimator has in its ROM, if there is one for the instrument [half units].
    pub edges: Option<Arc<[u32]>>,
}
