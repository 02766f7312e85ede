//! Literal values on the right of a comparison.

/// A number, possibly with don't-care digits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Literal {
    /// Text as written.
    pub(super) text: String,
    /// Bits; the magnitude of a negative number.
    value: u128,
    /// Mask of the don't-care bits.
    any: u128,
    negative: bool,
    /// Whether the text is a bit pattern, whose top bit may be a sign.
    pattern: bool,
}

impl Literal {
    /// Parses `12`, `-3`, `0x1f` or `0b1x0x`; `_` may separate digits.
    ///
    /// # Errors
    /// Description of what was expected.
    pub(super) fn parse(text: &str) -> Result<Self, &'static str> {
        const EXPECTED: &str = "expected a value: decimal, 0x.. or 0b.. with x for any digit";
        let lower = text.to_ascii_lowercase();
        let based = |prefix| lower.strip_prefix(prefix).map(|digits: &str| digits.to_owned());
        let (digits, bits) = match (based("0x"), based("0b")) {
            (Some(digits), _) => (digits, 4),
            (_, Some(digits)) => (digits, 1),
            _ => return Self::decimal(text).ok_or(EXPECTED),
        };
        let (mut value, mut any, mut count) = (0u128, 0u128, 0);
        for digit in digits.chars().filter(|&digit| digit != '_') {
            if (value | any) >> (128 - bits) != 0 {
                return Err("expected at most 128 bits");
            }
            let (of_value, of_any) = match digit {
                'x' => (0, (1 << bits) - 1),
                _ => (digit.to_digit(1 << bits).ok_or(EXPECTED)?, 0),
            };
            (value, any) = (value << bits | u128::from(of_value), any << bits | of_any);
            count += 1;
        }
        match count {
            0 => Err(EXPECTED),
            _ => Ok(Literal { text: text.to_owned(), value, any, negative: false, pattern: true }),
        }
    }

    fn decimal(text: &str) -> Option<Self> {
        let (negative, digits) = match text.strip_prefix('-') {
            Some(digits) => (true, digits),
            None => (false, text),
        };
        let digits = digits.replace('_', "");
        let only_digits = digits.bytes().all(|byte| byte.is_ascii_digit());
        let value = only_digits.then(|| digits.parse().ok()).flatten()?;
        let negative = negative && value != 0;
        Some(Literal { text: text.to_owned(), value, any: 0, negative, pattern: false })
    }

    /// Returns whether there are don't-care digits.
    pub(super) fn has_any(&self) -> bool {
        self.any != 0
    }

    /// Checks that a signal can have this value.
    ///
    /// # Errors
    /// Description of what was expected.
    pub(super) fn fits(&self, width: u32, signed: bool) -> Result<(), String> {
        let top = mask(width);
        let (low, high) = match (signed, self.pattern) {
            (true, false) => (1u128 << (width - 1), top >> 1),
            _ => (0, top),
        };
        let fits = if self.negative { self.value <= low } else { self.value <= high };
        let minus = if low > 0 { "-" } else { "" };
        if fits {
            Ok(())
        } else {
            Err(format!("expected {minus}{low} to {high}, a value of {width} bits"))
        }
    }

    /// Returns the bits for a signal of the given width, and the mask of those that matter.
    pub(super) fn bits(&self, width: u32) -> (u128, u128) {
        let value = if self.negative { self.value.wrapping_neg() } else { self.value };
        (value & mask(width), mask(width) & !self.any)
    }
}

/// Returns a mask of `width` ones, at most 128.
pub(super) fn mask(width: u32) -> u128 {
    u128::MAX.checked_shr(128 - width.min(128)).unwrap_or(0)
}
