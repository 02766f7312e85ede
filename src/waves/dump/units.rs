//! Units of time.

/// Units of time with their exponents [s], in steps of 1000.
pub const UNITS: [(i8, &str); 8] = [
    (0, "s"),
    (-3, "ms"),
    (-6, "us"),
    (-9, "ns"),
    (-12, "ps"),
    (-15, "fs"),
    (-18, "as"),
    (-21, "zs"),
];

/// Returns the number of units in 10 to the `exponent` seconds, and the unit: the largest of which it is a multiple.
/// Exponents are from -21 to 18.
pub fn unit(exponent: i8) -> (u64, &'static str) {
    let (of, name) = UNITS.into_iter().find(|(of, _)| *of <= exponent).unwrap_or(UNITS[7]);
    (10u64.pow((exponent - of).unsigned_abs().into()), name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_of_ten_is_1_10_or_100_of_a_unit() {
        let expected = [(-21, (1, "zs")), (-17, (10, "as")), (-10, (100, "ps")), (1, (10, "s"))];
        assert_eq!(expected.map(|(exponent, _)| (exponent, unit(exponent))), expected);
    }
}
