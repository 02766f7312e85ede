//! Rounding of double-precision weights to ROM words.

use crate::error::{Input, Result};
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::kernel::{Overflow, WordFormat};

use super::float::Float;
use super::weights::{Fixed, Weights};

/// Rounded weights, and the number of overflows.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    pub fixed: Fixed,
    /// Number of weights that were out of range and saturated.
    pub saturated: usize,
}

impl Float {
    /// Rounds all weights to a datapath's formats, halves away from zero. Messages name the network as `name`.
    ///
    /// # Errors
    /// If a weight is not a number, or is out of range and `overflow` does not allow saturation.
    pub fn round(&self, name: &str, datapath: &Datapath, overflow: Overflow) -> Result<Rounded> {
        let mut rounding = Rounding { name, overflow, saturated: 0 };
        let mut w1 = Vec::new();
        for (neuron, row) in self.w1.iter().enumerate() {
            w1.push(rounding.list(datapath.w1, row, &format!("w1[{neuron}]"))?);
        }
        let b1 = rounding.list(datapath.b1, &self.b1, "b1")?;
        let w2 = rounding.list(datapath.w2, &self.w2, "w2")?;
        let b2 = rounding.word(datapath.b2, self.b2, || "b2".to_owned())?;
        Ok(Rounded { fixed: Weights { w1, b1, w2, b2 }, saturated: rounding.saturated })
    }
}

struct Rounding<'a> {
    name: &'a str,
    overflow: Overflow,
    saturated: usize,
}

impl Rounding<'_> {
    /// Rounds a list of values.
    fn list(&mut self, format: WordFormat, values: &[f64], name: &str) -> Result<Vec<i32>> {
        let word = |(place, &value): (usize, &f64)| {
            self.word(format, value, || format!("{name}[{place}]"))
        };
        values.iter().enumerate().map(word).collect()
    }

    /// Rounds a value.
    fn word(&mut self, format: WordFormat, value: f64, field: impl Fn() -> String) -> Result<i32> {
        if let Some(word) = format.round(value, Overflow::Refuse) {
            return Ok(word as i32);
        }
        let word = format.round(value, self.overflow).ok_or_else(|| {
            let (least, largest) =
                (format.min() as f64 * format.lsb(), format.max() as f64 * format.lsb());
            let WordFormat { width, fraction } = format;
            let expected = format!(
                "expected {least} to {largest} ({width} bits, {fraction} fraction); train within \
                 the formats, choose others, or saturate"
            );
            Input::new(self.name, expected).field(field()).value(value)
        })?;
        self.saturated += 1;
        Ok(word as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::Network;

    #[test]
    fn the_shipped_networks_are_their_float_weights_rounded() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            let rounded = network
                .float
                .get()
                .unwrap()
                .round(name, &network.datapath, Overflow::Refuse)
                .unwrap();
            assert_eq!(rounded, Rounded { fixed: network.fixed, saturated: 0 });
        }
    }

    #[test]
    fn a_weight_that_does_not_fit_is_refused_by_name_or_saturated_and_counted() {
        let mut float = Network::builtin("ideal").unwrap().unwrap().twin();
        float.w1[2][7] = 0.01;
        float.b2 = -1.0;
        let error =
            float.round("a.json", &Datapath::THESIS, Overflow::Refuse).unwrap_err().to_string();
        assert!(error.starts_with("a.json: w1[2][7] = 0.01: expected -0.00390625 to"), "{error}");
        let rounded = float.round("a.json", &Datapath::THESIS, Overflow::Saturate).unwrap();
        assert_eq!((rounded.saturated, rounded.fixed.w1[2][7]), (2, 32767));
        assert_eq!(rounded.fixed.b2, -32768);
        float.b1[0] = f64::NAN;
        assert!(float.round("a.json", &Datapath::THESIS, Overflow::Saturate).is_err());
    }
}
