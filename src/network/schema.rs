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
            float: file.float.map(Arrays::weights).into(),
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
mod tests;
