//! Numbers in messages.

use std::borrow::Cow;

/// Longest number that is written without an exponent [characters].
const LONG: usize = 20;

/// Shortens a number of many digits, such as 0.000000000000000000001, by an exponent; other texts stay as they are.
pub fn short_number(text: &str) -> Cow<'_, str> {
    let is_digit = |letter: char| letter.is_ascii_digit() || letter == '.' || letter == '-';
    match text.parse::<f64>() {
        Ok(number) if text.len() > LONG && text.chars().all(is_digit) => {
            format!("{number:e}").into()
        }
        _ => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_long_number_gets_an_exponent() {
        for number in [0.1 + 0.2, 1e-7, f64::from(f32::MAX) * 1e-25, -1.5, u64::MAX as f64] {
            assert_eq!(short_number(&number.to_string()), number.to_string());
        }
        assert_eq!(short_number(&5e-324.to_string()), "5e-324");
        assert_eq!(short_number(&(-1.25e300).to_string()), "-1.25e300");
        for text in ["", "a text that is longer than a number", "1e5", "18446744073709551615"] {
            assert_eq!(short_number(text), text);
        }
    }
}
