//! Errors by a quantity of the scene.

use std::collections::BTreeMap;

use serde::Serialize;

use super::spread::Spread;

/// The errors of all rows that share a value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// The value, in the quantity's unit.
    pub value: f64,
    /// Their errors.
    #[serde(flatten)]
    pub spread: Spread,
}

/// Errors by value, none of which is negative or no number, in rising order of it.
pub(super) fn by(values: impl Iterator<Item = f64>, errors_m: &[Option<f64>]) -> Vec<Group> {
    // The bits of numbers from 0 on are in the order of the numbers.
    let mut groups: BTreeMap<u64, Vec<Option<f64>>> = BTreeMap::new();
    for (value, &error_m) in values.zip(errors_m) {
        groups.entry(value.to_bits()).or_default().push(error_m);
    }
    let group =
        |(bits, errors_m)| Group { value: f64::from_bits(bits), spread: Spread::of(errors_m) };
    groups.into_iter().map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_in_order_and_hold_their_errors() {
        let values = [0.3, 0.0, 0.3, 0.1];
        let errors = [Some(0.001), Some(0.002), None, Some(0.004)];
        let groups = by(values.into_iter(), &errors);
        let found: Vec<_> =
            groups.iter().map(|g| (g.value, g.spread.mean_mm, g.spread.failures)).collect();
        assert_eq!(found, [(0.0, Some(2.0), 0), (0.1, Some(4.0), 0), (0.3, Some(1.0), 1)]);
    }
}
