//! Results of measurements: values and drawings.

use crate::page::plot::Layer;
use crate::page::trace::Trace;

use super::values::Values;

/// Result of an item's measurement: values by name, and pictures in the order of the item's.
#[derive(Default)]
pub struct Measured {
    /// Values that rows, pictures and the reason name.
    pub values: Values,
    /// Pictures without their words.
    pub drawings: Vec<Drawing>,
}

impl From<Values> for Measured {
    fn from(values: Values) -> Self {
        Measured { values, drawings: Vec::new() }
    }
}

impl Measured {
    /// Adds a plot.
    pub fn layers(mut self, layers: Vec<Layer>) -> Self {
        self.drawings.push(Drawing::Layers(layers));
        self
    }

    /// Adds a whole picture.
    pub fn svg(mut self, svg: String) -> Self {
        self.drawings.push(Drawing::Svg(svg));
        self
    }

    /// Adds a timing diagram.
    pub fn trace(mut self, trace: Trace) -> Self {
        self.drawings.push(Drawing::Trace(trace));
        self
    }
}

/// A picture without its words.
pub enum Drawing {
    /// Layers of a plot.
    Layers(Vec<Layer>),
    /// A whole picture, drawn for a wide page.
    Svg(String),
    /// A timing diagram.
    Trace(Trace),
}
