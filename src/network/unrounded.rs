//! Weights of a network before rounding, which few commands need.

use std::borrow::Cow;

use crate::files::toml::Checked;

use super::float::Float;

/// Weights of a network before rounding, if they are known.
#[derive(Clone, Debug)]
pub enum Unrounded {
    /// The network has integers only.
    Unknown,
    /// Weights of a file, or of a training.
    Known(Float),
    /// Text of the section `[float]` of a built-in file, which is parsed when it is needed.
    BuiltIn(&'static str),
}

impl Unrounded {
    /// Returns whether there are any.
    pub fn is_known(&self) -> bool {
        !matches!(self, Unrounded::Unknown)
    }

    /// Returns the weights.
    pub fn get(&self) -> Option<Cow<'_, Float>> {
        match self {
            Unrounded::Unknown => None,
            Unrounded::Known(float) => Some(Cow::Borrowed(float)),
            Unrounded::BuiltIn(section) => {
                let checked = Checked::syntax("network", section).ok()?;
                checked.read().ok().map(Cow::Owned)
            }
        }
    }
}

impl PartialEq for Unrounded {
    fn eq(&self, other: &Unrounded) -> bool {
        self.get() == other.get()
    }
}

impl From<Option<Float>> for Unrounded {
    fn from(float: Option<Float>) -> Self {
        float.map_or(Unrounded::Unknown, Unrounded::Known)
    }
}
