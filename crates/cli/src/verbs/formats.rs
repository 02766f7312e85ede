//! Options that choose the number formats of the network.

use tofsim::error::{Input, Result};
use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::kernel::WordFormat;
use tofsim::scenario::Training;

/// A word of the datapath and its format.
type FormatOption = (&'static str, WordFormat);

/// Number formats of the network, over those that are there.
#[derive(Clone, Debug, clap::Args)]
pub struct Formats {
    /// Address bits of the table of activations, 4 to 16 [default: 12, as in the thesis]
    #[arg(long, value_name = "N")]
    lut_bits: Option<u32>,
    /// Width, 2 to 24, and fraction bits of w1, b1, w2, b2 or l1_out (activations), such as w1=16.23; may be
    /// repeated [default: those of the thesis's Table 6.4]
    #[arg(long = "format", value_name = "WORD=WIDTH.FRACTION", value_parser = word_format)]
    formats: Vec<FormatOption>,
}

impl Formats {
    /// Puts them over others.
    pub fn put_over(&self, datapath: &mut Datapath) {
        datapath.address_bits = self.lut_bits.unwrap_or(datapath.address_bits);
        for (word, format) in &self.formats {
            datapath.word(word).into_iter().for_each(|of_word| *of_word = *format);
        }
    }

    /// Checks a datapath that these were put over.
    ///
    /// # Errors
    /// When it cannot be built; the option at fault is named.
    pub fn check(&self, datapath: &Datapath) -> Result<()> {
        let Some((field, value, expected)) = datapath.fault() else { return Ok(()) };
        let option = match field.as_str() {
            "address_bits" => Input::new("--lut-bits", expected),
            _ => Input::new("--format", expected).field(field),
        };
        Err(option.value(value).into())
    }

    /// Has what a scenario's table says of them, where no option says otherwise.
    ///
    /// # Errors
    /// When the table has a number format that is none.
    pub fn put_under(&mut self, training: &Training, scenario: &str) -> Result<()> {
        self.lut_bits = self.lut_bits.or(training.lut_bits);
        let given = std::mem::take(&mut self.formats);
        for (word, format) in training.formats.given() {
            let read = word_format(&format!("{word}={format}")).map_err(|_| {
                let expected = "expected WIDTH.FRACTION, such as \"16.23\"";
                let fault = Input::new(format!("scenario {scenario}"), expected);
                fault.field(format!("training.formats.{word}")).value(format)
            })?;
            self.formats.push(read);
        }
        // The last one of a word counts.
        self.formats.extend(given);
        Ok(())
    }

    /// The options, each as a command says it.
    pub fn options(&self) -> Vec<(&'static str, String)> {
        let bits = self.lut_bits.iter().map(|bits| ("--lut-bits ", bits.to_string()));
        let format = |(word, WordFormat { width, fraction }): &FormatOption| {
            ("--format ", format!("{word}={width}.{fraction}"))
        };
        bits.chain(self.formats.iter().map(format)).collect()
    }
}

/// Reads a format.
fn word_format(text: &str) -> std::result::Result<FormatOption, String> {
    let expected =
        || format!("expected WORD=WIDTH.FRACTION, WORD one of {}", Datapath::WORDS.join(", "));
    let (name, format) = text.split_once('=').ok_or_else(expected)?;
    let word = Datapath::WORDS.into_iter().find(|&word| word == name).ok_or_else(expected)?;
    let (width, fraction) = format.split_once('.').ok_or_else(expected)?;
    let number = |digits: &str| digits.parse().map_err(|_| expected());
    Ok((word, WordFormat { width: number(width)?, fraction: number(fraction)? }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_is_read() {
        assert_eq!(word_format("w1=12.19"), Ok(("w1", WordFormat { width: 12, fraction: 19 })));
        assert_eq!(word_format("l1_out=8.7"), Ok(("l1_out", WordFormat { width: 8, fraction: 7 })));
    }

    #[test]
    fn what_is_no_format_is_refused_with_what_is_one() {
        for text in ["", "w1", "w3=12.19", "w1=12", "w1=a.3", "w1=12.-3", "w1=12.3.4"] {
            let error = word_format(text).unwrap_err();
            assert!(error.contains("WORD one of w1, b1, w2, b2, l1_out"), "{text}: {error}");
        }
    }
}
