//! Ranges and labels of the axes of a sweep's picture.

use tofsim_studies::table::Field;

/// The place of a column.
pub fn place(fields: &[Field], name: &str) -> Option<usize> {
    fields.iter().position(|field| field.name == name)
}

/// The range of some numbers, with a little room on both sides.
pub fn range(numbers: impl Iterator<Item = f64>, is_log: bool) -> Option<[f64; 2]> {
    let [low, high] = numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], number| {
        [low.min(number), high.max(number)]
    });
    if !(low.is_finite() && high.is_finite()) || (is_log && low <= 0.0) {
        return None;
    }
    Some(match (is_log, low < high) {
        (true, _) => [low / 1.1, high * 1.1],
        (false, true) => {
            let room = 0.05 * (high - low);
            [if low >= 0.0 && low < room { 0.0 } else { low - room }, high + room]
        }
        (false, false) => [low - 0.5 * low.abs().max(1e-9), high + 0.5 * high.abs().max(1e-9)],
    })
}

/// A number along an axis, in four digits at most.
pub fn tick(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    match rounded.abs() {
        0.0 | 1e-3..1e6 => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}
