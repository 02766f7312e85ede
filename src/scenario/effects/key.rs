//! A key of the scenario, by which a program reads it and sets it to its default.

use std::sync::LazyLock;

use serde::Serialize;
use serde_json::Value as Json;

use crate::note::NoteValue;
use crate::scenario::Scenario;

/// The scenario of nothing but defaults.
pub static USUAL: LazyLock<Scenario> = LazyLock::new(Scenario::default);

/// A key of the scenario.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its path, such as `spad.pulse_ns`.
    pub name: &'static str,
    is_usual: fn(&Scenario) -> bool,
    value: fn(&Scenario) -> NoteValue,
    set_usual: fn(&mut Scenario),
}

impl Key {
    #[doc(hidden)]
    pub const fn new(
        name: &'static str,
        is_usual: fn(&Scenario) -> bool,
        value: fn(&Scenario) -> NoteValue,
        set_usual: fn(&mut Scenario),
    ) -> Self {
        Key { name, is_usual, value, set_usual }
    }

    /// Whether the key has its default.
    pub fn is_usual(&self, scenario: &Scenario) -> bool {
        (self.is_usual)(scenario)
    }

    /// Returns the key's value.
    pub fn value(&self, scenario: &Scenario) -> NoteValue {
        (self.value)(scenario)
    }

    /// Returns the key's default.
    pub fn usual(&self) -> NoteValue {
        self.value(&USUAL)
    }

    /// Sets the key to its default.
    pub fn set_usual(&self, scenario: &mut Scenario) {
        (self.set_usual)(scenario);
    }
}

/// Returns a value as a note shows it: a list by the number of its entries.
pub fn shown(value: &impl Serialize) -> NoteValue {
    match serde_json::to_value(value) {
        Ok(Json::Number(number)) => number.as_f64().map_or(NoteValue::None, NoteValue::Number),
        Ok(Json::String(text)) => NoteValue::Text(text),
        Ok(Json::Bool(flag)) => NoteValue::Flag(flag),
        Ok(Json::Array(entries)) => NoteValue::Number(entries.len() as f64),
        _ => NoteValue::None,
    }
}

/// Makes a [`Key`] of the fields that lead to it: `key!(spad.pulse_ns)`.
macro_rules! key {
    ($first:ident $(.$next:ident)*) => {
        $crate::scenario::effects::key::Key::new(
            concat!(stringify!($first) $(, ".", stringify!($next))*),
            |scenario| scenario.$first$(.$next)* == $crate::scenario::effects::key::USUAL.$first$(.$next)*,
            |scenario| $crate::scenario::effects::key::shown(&scenario.$first$(.$next)*),
            |scenario| {
                scenario.$first$(.$next)*.clone_from(&$crate::scenario::effects::key::USUAL.$first$(.$next)*)
            },
        )
    };
}

pub(crate) use key;
