//! `--format WORD=WIDTH.FRACTION`.

use tofsim::network::formats::WordFormat;
use tofsim_learn::quantize::Datapath;

/// A word of the datapath and its format.
pub type FormatOption = (&'static str, WordFormat);

/// Reads one.
pub fn word_format(text: &str) -> Result<FormatOption, String> {
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
