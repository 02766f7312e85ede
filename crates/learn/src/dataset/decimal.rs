//! Decimals as a user types them, without the error that binary numbers have.

use std::fmt;

/// Most digits of a decimal, and its largest exponent.
const DIGITS: usize = 18;

/// `digits / 10^places`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decimal {
    digits: i128,
    places: u32,
}

impl Decimal {
    /// The number in a text such as `0.05`, `.5` or `1.5e-3`; none if it is no number, or too long.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let exponent: i32 = exponent.parse().ok().filter(|exp: &i32| exp.abs() <= DIGITS as i32)?;
        let (sign, number) = match number.strip_prefix('-') {
            Some(number) => (-1, number),
            None => (1, number.strip_prefix('+').unwrap_or(number)),
        };
        let (whole, part) = number.split_once('.').unwrap_or((number, ""));
        let digits = format!("{whole}{part}");
        let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        if !is_number || digits.len() > DIGITS {
            return None;
        }
        let digits: i128 = digits.parse().ok()?;
        let places = part.len() as i32 - exponent;
        let (digits, places) = match u32::try_from(places) {
            Ok(places) => (digits, places),
            Err(_) => (digits * 10i128.pow(places.unsigned_abs()), 0),
        };
        Some(Decimal { digits: sign * digits, places }.shortest())
    }

    /// `first`, `first + step` and so on up to `last`, which belongs to them if whole steps lead there;
    /// none if there are none, or more than `most`.
    pub fn steps(first: Self, last: Self, step: Self, most: usize) -> Option<Vec<Self>> {
        let places = first.places.max(last.places).max(step.places);
        let [first, last, step] = [first, last, step].map(|number| number.with(places));
        let (first, last, step) = (first?, last?, step?);
        if step <= 0 || last < first {
            return None;
        }
        let count = usize::try_from((last - first) / step + 1).ok().filter(|&n| n <= most)?;
        let value = |k| Decimal { digits: first + k as i128 * step, places }.shortest();
        Some((0..count).map(value).collect())
    }

    /// Its digits with so many places.
    fn with(self, places: u32) -> Option<i128> {
        self.digits.checked_mul(10i128.checked_pow(places - self.places)?)
    }

    /// The same without zeros at the end.
    fn shortest(mut self) -> Self {
        while self.places > 0 && self.digits % 10 == 0 {
            self = Decimal { digits: self.digits / 10, places: self.places - 1 };
        }
        self
    }

    /// The binary number next to it.
    pub fn value(self) -> f64 {
        // What Display writes is a number.
        self.to_string().parse().unwrap_or(f64::NAN)
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (sign, size) = (if self.digits < 0 { "-" } else { "" }, self.digits.unsigned_abs());
        let unit = 10u128.pow(self.places);
        match self.places {
            0 => write!(f, "{sign}{size}"),
            places => {
                write!(f, "{sign}{}.{:0width$}", size / unit, size % unit, width = places as usize)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> Option<String> {
        Decimal::parse(text).map(|decimal| decimal.to_string())
    }

    #[test]
    fn decimals_are_what_was_typed() {
        for (typed, expected) in [
            ("0.05", "0.05"),
            (".9", "0.9"),
            ("15000", "15000"),
            ("1.50", "1.5"),
            ("-0.025", "-0.025"),
            ("1.5e-3", "0.0015"),
            ("2E3", "2000"),
            ("1e18", "1000000000000000000"),
        ] {
            assert_eq!(shown(typed).as_deref(), Some(expected));
            assert_eq!(Decimal::parse(typed).unwrap().value(), typed.parse::<f64>().unwrap());
        }
        for typed in ["", ".", "-", "1..2", "nan", "inf", "1e99", "0x10", "1234567890123456789"] {
            assert_eq!(shown(typed), None, "{typed}");
        }
    }

    #[test]
    fn steps_end_at_the_last_or_before_it() {
        let steps = |of: [&str; 3]| {
            let [first, last, step] = of.map(|text| Decimal::parse(text).unwrap());
            let steps = Decimal::steps(first, last, step, 1000)?;
            Some(steps.iter().map(ToString::to_string).collect::<Vec<_>>())
        };
        assert_eq!(steps(["0.1", "0.3", "0.1"]).unwrap(), ["0.1", "0.2", "0.3"]);
        assert_eq!(steps(["0.1", "0.35", "0.1"]).unwrap(), ["0.1", "0.2", "0.3"]);
        assert_eq!(steps(["5", "5", "1e-18"]).unwrap(), ["5"]);
        assert_eq!(steps(["0.05", "0.9", "0.0025"]).unwrap().len(), 341);
        assert_eq!(steps(["0", "1", "0.001"]), None, "1001 of them");
        assert_eq!(steps(["1", "0", "0.1"]), None);
        assert_eq!(steps(["0", "1", "-0.1"]), None);
        assert_eq!(steps(["0", "999999999999999999", "1e-18"]), None);
    }
}
