//! Fields of a network file, and their constraints.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::Result;
use crate::files::toml::Checked;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward2::MOST_NEURONS;
use crate::kernel::WordFormat;

use super::domain::Domain;
use super::file::{Accuracy, Network, Training};
use super::weights::Weights;

/// Value of the key `schema`.
pub(super) const SCHEMA: &str = "tofsim.network/1";
/// Keys of `[scaling]`, each with the only value that the firmware's arithmetic supports.
pub(super) const SCALING: [(&str, &str); 3] =
    [("input", "counts"), ("output", "metres"), ("normalisation", "folded")];

/// Contents of a network file.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct File {
    schema: String,
    description: String,
    training: Training,
    domain: Option<Domain>,
    accuracy: Option<Accuracy>,
    scaling: Scaling,
    formats: Formats,
    integers: Arrays<i32>,
    float: Option<Arrays<f64>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scaling {
    input: String,
    output: String,
    normalisation: String,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Formats {
    w1: WordFormat,
    b1: WordFormat,
    w2: WordFormat,
    b2: WordFormat,
    l1_out: WordFormat,
    tansig: TansigFormat,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TansigFormat {
    address_bits: u32,
    range: u32,
}

/// Weights and biases: `w1[neuron][bin]`, `b1[neuron]`, `w2[neuron]`, `b2`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Arrays<T> {
    #[schemars(length(min = 1, max = MOST_NEURONS), inner(length(min = 16, max = 1024)))]
    w1: Vec<Vec<T>>,
    b1: Vec<T>,
    w2: Vec<T>,
    b2: T,
}

impl<T: Copy> Arrays<T> {
    fn weights(self) -> Weights<T, T, T, T> {
        let Arrays { w1, b1, w2, b2 } = self;
        Weights { w1, b1, w2, b2 }
    }

    /// Checks the lengths of all lists against the numbers of neurons and bins.
    fn check(
        &self,
        section: &str,
        (neurons, bins): (usize, usize),
        checked: &Checked,
    ) -> Result<()> {
        if let Some(row) = self.w1.iter().position(|row| row.len() != bins) {
            let expected = format!("expected a list of {bins}, one a bin");
            return Err(checked.fault(&format!("{section}.w1.{row}"), expected).into());
        }
        for (key, found) in [("w1", self.w1.len()), ("b1", self.b1.len()), ("w2", self.w2.len())] {
            if found != neurons {
                let expected = format!("expected {neurons}, one a neuron");
                return Err(checked.fault(&format!("{section}.{key}"), expected).into());
            }
        }
        Ok(())
    }
}

impl Network {
    /// Parses the text of a network file. Errors name it as `source`.
    ///
    /// # Errors
    /// If the text is not TOML, a key is missing, unknown or out of range, or a weight does not fit its format.
    pub fn parse(text: &str, source: &str) -> Result<Network> {
        let checked = Checked::parse::<File>(source, text)?;
        let file: File = checked.read()?;
        let datapath = file.check(&checked)?;
        Ok(Network {
            name: source.to_owned(),
            description: file.description,
            training: file.training,
            domain: file.domain,
            accuracy: file.accuracy,
            datapath,
            fixed: file.integers.weights(),
            float: file.float.map(Arrays::weights),
        })
    }
}

impl File {
    /// Checks the constraints that the schema does not express.
    fn check(&self, checked: &Checked) -> Result<Datapath> {
        let fault = |key: &str, expected: String| -> Result<Datapath> {
            Err(checked.fault(key, expected).into())
        };
        if self.schema != SCHEMA {
            return fault("schema", format!("expected \"{SCHEMA}\""));
        }
        let scaling = [&self.scaling.input, &self.scaling.output, &self.scaling.normalisation];
        for (found, (key, word)) in scaling.into_iter().zip(SCALING) {
            if found != word {
                return fault(&format!("scaling.{key}"), format!("expected \"{word}\""));
            }
        }
        let datapath = self.formats.datapath(checked)?;
        let w1 = &self.integers.w1;
        let size = (w1.len(), w1.first().map_or(0, Vec::len));
        if !size.1.is_power_of_two() {
            let expected = "expected a list of 16, 32, 64 and so on to 1024: a power of two";
            return fault("integers.w1.0", expected.to_owned());
        }
        self.integers.check("integers", size, checked)?;
        self.integers.check_words(&datapath, checked)?;
        if let Some(float) = &self.float {
            float.check("float", size, checked)?;
        }
        let Some(accuracy) = &self.accuracy else { return Ok(datapath) };
        let distances = accuracy.distances_m.len();
        let columns =
            [("two_sd_mm", Some(&accuracy.two_sd_mm)), ("mean_mm", accuracy.mean_mm.as_ref())];
        for (key, column) in columns {
            if column.is_some_and(|column| column.len() != distances) {
                let expected = format!("expected one a distance: {distances}");
                return fault(&format!("accuracy.{key}"), expected);
            }
        }
        Ok(datapath)
    }
}

impl Arrays<i32> {
    /// Checks that each weight fits its format.
    fn check_words(&self, datapath: &Datapath, checked: &Checked) -> Result<()> {
        let row = |(neuron, row): (usize, &Vec<i32>)| {
            outside(datapath.w1, row).map(|place| (format!("w1.{neuron}.{place}"), datapath.w1))
        };
        let list = |key: &str, format: WordFormat, words: &[i32]| {
            outside(format, words).map(|place| (format!("{key}.{place}"), format))
        };
        let b2 = || outside(datapath.b2, &[self.b2]).map(|_| ("b2".to_owned(), datapath.b2));
        let found = self.w1.iter().enumerate().find_map(row);
        let found = found.or_else(|| list("b1", datapath.b1, &self.b1));
        let found = found.or_else(|| list("w2", datapath.w2, &self.w2)).or_else(b2);
        let Some((key, format)) = found else { return Ok(()) };
        let expected = format!("expected a whole number from {} to {}", format.min(), format.max());
        Err(checked.fault(&format!("integers.{key}"), expected).into())
    }
}

/// Returns the index of the first integer that does not fit the format.
fn outside(format: WordFormat, words: &[i32]) -> Option<usize> {
    words.iter().position(|&word| !(format.min()..=format.max()).contains(&i64::from(word)))
}

impl Formats {
    /// Returns the datapath with the file's formats.
    ///
    /// # Errors
    /// If it cannot be built.
    fn datapath(&self, checked: &Checked) -> Result<Datapath> {
        let TansigFormat { address_bits, range } = self.tansig;
        if !range.is_power_of_two() {
            let expected = "expected 1, 2, 4 and so on to 64";
            return Err(checked.fault("formats.tansig.range", expected).into());
        }
        let (w1, b1, w2, b2, l1_out) = (self.w1, self.b1, self.w2, self.b2, self.l1_out);
        let range_log2 = range.ilog2();
        let datapath = Datapath { w1, b1, w2, b2, l1_out, address_bits, range_log2 };
        match datapath.fault() {
            None => Ok(datapath),
            Some((field, _, expected)) => {
                let key = match field.as_str() {
                    "address_bits" => "tansig.address_bits".to_owned(),
                    "range_log2" => "tansig.range".to_owned(),
                    _ => field,
                };
                Err(checked.fault(&format!("formats.{key}"), expected).into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the error message for the built-in file with a piece of its text replaced.
    fn fault(from: &str, to: &str) -> String {
        let text = Network::builtin_text("uniform").unwrap();
        assert!(text.contains(from), "{from}");
        Network::parse(&text.replacen(from, to, 1), "a.toml").unwrap_err().to_string()
    }

    /// Returns the start of the file's first row of integers, and the same with the first integer replaced by `word`.
    fn first(word: &str) -> (String, String) {
        let network = Network::builtin("uniform").unwrap().unwrap();
        let begin = |word: &str| format!("w1 = [\n  [\n    {word}");
        let old = format!("{}, ", network.fixed.w1[0][0]);
        (begin(&old), begin(word))
    }

    #[test]
    fn a_weight_outside_its_word_is_named_with_its_range() {
        let (from, to) = first("40000, ");
        let message = fault(&from, &to);
        let expected = "integers.w1.0.0 = 40000: expected a whole number from -32768 to 32767";
        assert!(message.starts_with("a.toml:") && message.ends_with(expected), "{message}");
    }

    #[test]
    fn a_weight_that_is_no_integer_is_named() {
        let (from, to) = first("-89.5, ");
        let message = fault(&from, &to);
        assert!(message.contains("integers.w1.0.0 = -89.5: expected a whole number"), "{message}");
    }

    #[test]
    fn a_row_of_the_wrong_length_is_named() {
        let (from, to) = first("");
        let message = fault(&from, &to);
        assert!(
            message.contains("integers.w1.0 = a list of 255: expected a list of 16, 32, 64"),
            "{message}"
        );
    }

    #[test]
    fn formats_that_cannot_be_built_are_refused() {
        let message = fault("fraction = 23", "fraction = 12");
        assert!(message.contains("formats.b1.fraction = 13: expected 0 to 12"), "{message}");
        let message = fault("address_bits = 12", "address_bits = 20");
        assert!(
            message.contains("formats.tansig.address_bits = 20: expected 4 to 16"),
            "{message}"
        );
        let message = fault("range = 4", "range = 5");
        assert!(message.contains("formats.tansig.range = 5: expected 1, 2, 4"), "{message}");
    }

    #[test]
    fn a_missing_field_and_an_unknown_key_are_named() {
        let message = fault("chain = ", "chian = ");
        assert!(message.contains("training.chain: missing"), "{message}");
        let message = fault("[scaling]\n", "[scaling]\noutptu = 1\n");
        let expected = "scaling.outptu: unknown key; did you mean `output`?";
        assert!(message.ends_with(expected), "{message}");
    }

    #[test]
    fn a_fault_of_syntax_has_line_and_column() {
        let error = Network::parse("schema = \"x\"\nb = [1, 2\n", "a.toml").unwrap_err();
        assert!(error.to_string().starts_with("a.toml:2:"), "{error}");
        assert!(error.to_string().contains("unclosed array"), "{error}");
    }

    #[test]
    fn values_of_the_wrong_kind_are_refused() {
        for (from, to, expected) in [
            ("\"counts\"", "3", "scaling.input = 3: expected a text in quotes"),
            ("\"counts\"", "\"hits\"", "scaling.input = \"hits\": expected \"counts\""),
            ("\"tofsim.network/1\"", "\"tofsim.network/9\"", "expected \"tofsim.network/1\""),
            (
                "\"target.distance_m\" = [0.1, 0.6]",
                "\"target.distance_m\" = [0.1]",
                "domain.ranges.target.distance_m = [0.1]: expected a list of 2",
            ),
            ("b2 = 3", "b2 = \"3\" #", "integers.b2 = \"3\": expected a whole number"),
            (
                "two_sd_mm = [",
                "two_sd_mm = [1.0, ",
                "accuracy.two_sd_mm = [1.0, 1.24, 2.29, 2.45, 2.27, 2.88, 4.7]: expected one a distance: 6",
            ),
            ("[float]\n", "[float]\nb3 = nan\n", "float.b3: unknown key"),
            (
                "w2 = [\n    ",
                "w2 = [\n    1, ",
                "integers.w2 = a list of 9: expected 8, one a neuron",
            ),
            (
                "w1 = [\n  [",
                "w1 = [\n  [1],\n  [",
                "integers.w1.0 = [1]: expected a list of 16 to 1024",
            ),
        ] {
            let message = fault(from, to);
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn the_float_weights_may_be_absent() {
        let text = Network::builtin_text("uniform").unwrap();
        let (integers, _) = text.split_once("[float]").unwrap();
        assert_eq!(Network::parse(integers, "a.toml").unwrap().float, None);
    }
}
