//! Named arrays of numbers, whatever file they come from.

use std::collections::BTreeMap;

use tofsim::error::{Error, Input, Result, nearest};

/// Names that mean something.
const NAMES: &str = "IW, LW, b1, b2, x_xoffset, x_gain, x_ymin, x_keep, y_xoffset, y_gain, y_ymin";

/// Numbers in the order of C, the last index fastest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    name: String,
    shape: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// The arrays of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arrays {
    /// The file's name in messages.
    pub(super) name: String,
    pub(super) arrays: BTreeMap<String, Array>,
}

impl Arrays {
    /// None yet.
    pub(super) fn new(name: impl ToString) -> Self {
        Arrays { name: name.to_string(), arrays: BTreeMap::new() }
    }

    /// Adds one.
    pub(super) fn put(&mut self, name: &str, shape: Vec<usize>, values: Vec<f64>) {
        let array = Array { name: name.to_owned(), shape, values };
        self.arrays.insert(name.to_owned(), array);
    }

    /// Takes one that may be absent.
    pub(super) fn optional(&mut self, name: &str) -> Option<Array> {
        self.arrays.remove(name)
    }

    /// Takes one that has to be there.
    pub(super) fn required(&mut self, name: &str) -> Result<Array> {
        self.optional(name).ok_or_else(|| self.fault(name, "missing").into())
    }

    /// Refuses those that nobody took.
    pub(super) fn finish(&self) -> Result<()> {
        let Some(name) = self.arrays.keys().next() else { return Ok(()) };
        let hint = match nearest(name, NAMES.split(", ")) {
            Some(near) => format!("did you mean {near}?"),
            None => format!("expected {NAMES}"),
        };
        Err(self.fault(name, &format!("unknown; {hint}")).into())
    }

    /// An error about one of them.
    pub(super) fn fault(&self, name: &str, expected: &str) -> Input {
        Input::new(&self.name, expected).field(name)
    }
}

impl Array {
    /// The numbers, if they are finite and have that shape, lengths of 1 aside.
    pub(super) fn shaped(self, arrays: &Arrays, expected: &[usize]) -> Result<Vec<f64>> {
        let long = |shape: &[usize]| -> Vec<usize> {
            shape.iter().copied().filter(|&len| len != 1).collect()
        };
        if long(&self.shape) != long(expected) {
            let spelled = |shape: &[usize]| {
                let lengths: Vec<_> = shape.iter().map(usize::to_string).collect();
                if lengths.is_empty() { "1".to_owned() } else { lengths.join(" x ") }
            };
            let expected = format!("{}, expected {}", spelled(&self.shape), spelled(expected));
            return Err(arrays.fault(&self.name, &expected).into());
        }
        if let Some(place) = self.values.iter().position(|value| !value.is_finite()) {
            let field = format!("{}[{place}]", self.name);
            let fault = arrays.fault(&field, "expected a finite number");
            return Err(Error::from(fault.value(self.values[place])));
        }
        Ok(self.values)
    }
}
