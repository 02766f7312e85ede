//! Numbers that TOML does not accept as commonly written.

/// Converts a number such as `.9`, `5.`, `-.5e3` or `007` to TOML's syntax.
pub(super) fn number(text: &str) -> Option<String> {
    let is_one = |letter: char| letter.is_ascii_digit() || ".+-eE".contains(letter);
    let number: f64 = text.parse().ok().filter(|_| text.chars().all(is_one))?;
    match text.parse::<i64>() {
        Ok(whole) => Some(whole.to_string()),
        // With a point or an exponent, so that it is a number of the same kind there.
        Err(_) => number.is_finite().then(|| format!("{number:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_all_their_digits_are_numbers() {
        let cases = [(".9", "0.9"), ("5.", "5.0"), ("-.5e3", "-500.0"), ("+.25", "0.25")];
        for (text, expected) in cases {
            assert_eq!(number(text).as_deref(), Some(expected), "{text}");
        }
        assert_eq!(number("007").as_deref(), Some("7"));
    }

    #[test]
    fn what_is_no_number_is_none() {
        for text in ["", ".", "-", "e5", "1.2.3", "inf", "nan", "infinity", "0x1", "1e999", ". 9"] {
            assert_eq!(number(text), None, "{text}");
        }
    }
}
