//! Declaration of a signal in the header of a VCD.

use std::collections::HashSet;

use tofsim::error::{Error, Input};

/// A declared signal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Variable {
    pub(crate) name: String,
    /// Width [bits].
    pub(crate) width: u32,
    pub(crate) values: Values,
}

/// Values that a signal may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Values {
    Bits,
    Real,
    Text,
    Event,
}

impl Variable {
    /// Parses a declaration, and changes its type if it has words, as those with the codes `texts` have.
    ///
    /// # Errors
    /// If it is no declaration that is read.
    pub(crate) fn parse(
        body: &mut [Vec<u8>],
        texts: &HashSet<Vec<u8>>,
    ) -> std::result::Result<Variable, Wrong> {
        let shown = |words: &[Vec<u8>]| String::from_utf8_lossy(&words.join(&b' ')).into_owned();
        let [kind, width, code, name @ ..] = body else {
            let expected = "expected a type, a width, a code and a name";
            return Err(Wrong::new("$var", shown(body), expected));
        };
        let name = shown(name);
        let bits = std::str::from_utf8(width).ok().and_then(|width| width.parse().ok());
        let Some(bits) = bits else {
            let width = String::from_utf8_lossy(width).into_owned();
            return Err(Wrong::new(&name, width, "expected a width in bits"));
        };
        if texts.contains(code) {
            *kind = b"string".to_vec();
        }
        let values = match &kind[..] {
            b"string" => Values::Text,
            b"real" | b"realtime" | b"shortreal" | b"real_parameter" => Values::Real,
            b"event" => Values::Event,
            b"port" => {
                let expected =
                    "is of an extended VCD ($dumpports), which is not read: use $dumpvars";
                return Err(Wrong::new(&name, "port".into(), expected));
            }
            _ => Values::Bits,
        };
        Ok(Variable { name, width: bits, values })
    }
}

/// Invalid field of a command, and what was expected.
pub(crate) struct Wrong {
    field: String,
    value: String,
    expected: String,
}

impl Wrong {
    pub(crate) fn new(field: &str, value: String, expected: impl Into<String>) -> Wrong {
        Wrong { field: field.to_owned(), value, expected: expected.into() }
    }

    pub(crate) fn of(self, fault: &dyn Fn(String) -> Input) -> Error {
        fault(self.expected).field(self.field).value(self.value).into()
    }
}
