//! `--format WORD=WIDTH.FRACTION`.

use std::fmt::{self, Display};
use std::str::FromStr;

use tofsim::network::formats::WordFormat;
use tofsim_learn::quantize::Datapath;

/// A word of the datapath and its format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormatOption {
    word: &'static str,
    format: WordFormat,
}

impl FormatOption {
    /// Takes it into a datapath.
    pub fn set(&self, datapath: &mut Datapath) {
        if let Some(format) = datapath.word(self.word) {
            *format = self.format;
        }
    }
}

impl FromStr for FormatOption {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let expected =
            || format!("expected WORD=WIDTH.FRACTION, WORD one of {}", Datapath::WORDS.join(", "));
        let (name, format) = text.split_once('=').ok_or_else(expected)?;
        let word = Datapath::WORDS.into_iter().find(|&word| word == name).ok_or_else(expected)?;
        let (width, fraction) = format.split_once('.').ok_or_else(expected)?;
        let number = |digits: &str| digits.parse().map_err(|_| expected());
        Ok(FormatOption {
            word,
            format: WordFormat { width: number(width)?, fraction: number(fraction)? },
        })
    }
}

impl Display for FormatOption {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let WordFormat { width, fraction } = self.format;
        write!(f, "{}={width}.{fraction}", self.word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_is_read_and_written_alike() {
        let mut datapath = Datapath::default();
        for text in ["w1=12.19", "l1_out=8.7"] {
            let format: FormatOption = text.parse().unwrap();
            format.set(&mut datapath);
            assert_eq!(format.to_string(), text);
        }
        assert_eq!(datapath.w1, WordFormat { width: 12, fraction: 19 });
        assert_eq!(datapath.l1_out, WordFormat { width: 8, fraction: 7 });
    }

    #[test]
    fn what_is_no_format_is_refused_with_what_is_one() {
        for text in ["", "w1", "w3=12.19", "w1=12", "w1=a.3", "w1=12.-3", "w1=12.3.4"] {
            let error = text.parse::<FormatOption>().unwrap_err();
            assert!(error.contains("WORD one of w1, b1, w2, b2, l1_out"), "{text}: {error}");
        }
    }
}
