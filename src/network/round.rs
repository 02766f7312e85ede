//! From weights in double precision to the words of the ROMs (thesis Table 6.4).

use crate::error::{Input, Result};

use super::float::Float;
use super::formats::{
    B1, B2, Fixed, HiddenBias, HiddenWeight, OutputBias, OutputWeight, Overflow, W1, W2, WordFormat,
};
use super::weights::Weights;

/// Rounded weights, and what did not fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    pub fixed: Fixed,
    /// Weights that no word holds, and were saturated.
    pub saturated: usize,
}

impl Float {
    /// The nearest words, halves away from zero; `name` is the network's in messages.
    ///
    /// # Errors
    /// When a weight does not fit and is not to be saturated, or is no number.
    pub fn round(&self, name: &str, overflow: Overflow) -> Result<Rounded> {
        let mut rounding = Rounding { name, overflow, saturated: 0 };
        let mut w1 = Vec::new();
        for (neuron, row) in self.w1.iter().enumerate() {
            let words = row.iter().enumerate().map(|(bin, &weight)| {
                let bits = rounding.word(W1, weight, || format!("w1[{neuron}][{bin}]"))?;
                Ok(HiddenWeight::from_bits(bits.into()))
            });
            w1.push(words.collect::<Result<_>>()?);
        }
        let b1 = rounding.list(B1, &self.b1, "b1")?.map(HiddenBias::from_bits).collect();
        let w2 = rounding.list(W2, &self.w2, "w2")?.map(OutputWeight::from_bits).collect();
        let b2 = OutputBias::from_bits(rounding.word(B2, self.b2, || "b2".to_owned())?.into());
        Ok(Rounded { fixed: Weights { w1, b1, w2, b2 }, saturated: rounding.saturated })
    }
}

struct Rounding<'a> {
    name: &'a str,
    overflow: Overflow,
    saturated: usize,
}

impl Rounding<'_> {
    /// The words nearest to values.
    fn list(
        &mut self,
        format: WordFormat,
        values: &[f64],
        name: &str,
    ) -> Result<impl Iterator<Item = i16> + use<>> {
        let word = |(place, &value): (usize, &f64)| {
            self.word(format, value, || format!("{name}[{place}]"))
        };
        let words: Result<Vec<i16>> = values.iter().enumerate().map(word).collect();
        Ok(words?.into_iter())
    }

    /// The word of 16 bits nearest to a value.
    fn word(&mut self, format: WordFormat, value: f64, field: impl Fn() -> String) -> Result<i16> {
        if let Some(word) = format.round(value, Overflow::Refuse) {
            return Ok(word as i16);
        }
        let saturated = format.round(value, self.overflow);
        let word = saturated.ok_or_else(|| {
            let lsb = (-f64::from(format.fraction)).exp2();
            let (least, largest) = (format.min() as f64 * lsb, format.max() as f64 * lsb);
            let expected = format!(
                "expected {least} to {largest} (16 bits, {} fraction); train within the \
                 formats, or saturate",
                format.fraction
            );
            Input::new(self.name, expected).field(field()).value(value)
        })?;
        self.saturated += 1;
        Ok(word as i16)
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
            let rounded = network.float.unwrap().round(name, Overflow::Refuse).unwrap();
            assert_eq!(rounded, Rounded { fixed: network.fixed, saturated: 0 });
        }
    }

    #[test]
    fn a_weight_that_does_not_fit_is_refused_by_name_or_saturated_and_counted() {
        let mut float = Network::builtin("ideal").unwrap().unwrap().twin();
        float.w1[2][7] = 0.01;
        float.b2 = -1.0;
        let error = float.round("a.json", Overflow::Refuse).unwrap_err().to_string();
        assert!(error.starts_with("a.json: w1[2][7] = 0.01: expected -0.00390625 to"), "{error}");
        let rounded = float.round("a.json", Overflow::Saturate).unwrap();
        assert_eq!((rounded.saturated, rounded.fixed.w1[2][7].to_bits()), (2, 32767));
        assert_eq!(rounded.fixed.b2.to_bits(), -32768);
        float.b1[0] = f64::NAN;
        assert!(float.round("a.json", Overflow::Saturate).is_err());
    }
}
