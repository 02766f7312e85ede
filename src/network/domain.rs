//! Training domain of a network.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scenario settings for which a network's training histograms were drawn, by key (`target.distance_m`). The
/// network's accuracy is unknown in other scenarios.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Smallest and largest value of each numeric key, in its unit; equal if there was one value.
    pub ranges: BTreeMap<String, [f64; 2]>,
    /// Value of each key that holds a word or a name.
    pub words: BTreeMap<String, String>,
}

/// Relative tolerance for decimal values in binary representation [1].
const ROUNDING: f64 = 1e-9;

/// Returns whether the values from `found[0]` to `found[1]` lie within `range`.
pub fn holds(range: [f64; 2], found: [f64; 2]) -> bool {
    let slack = |limit: f64| limit.abs() * ROUNDING;
    found[0] >= range[0] - slack(range[0]) && found[1] <= range[1] + slack(range[1])
}

/// Formats a range: `0.1 to 0.6`, or a single value.
pub fn in_words([least, largest]: [f64; 2]) -> String {
    if least == largest { least.to_string() } else { format!("{least} to {largest}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_range_belong_to_it() {
        assert!(holds([0.1, 0.6], [0.1, 0.6]));
        assert!(holds([0.1, 0.6], [0.3, 0.1 + 0.2 + 0.3]), "six tenths, not quite");
        assert!(!holds([0.1, 0.6], [0.0999, 0.3]) && !holds([0.1, 0.6], [0.3, 0.601]));
        assert!(holds([30_000.0; 2], [30_000.0; 2]) && !holds([30_000.0; 2], [29_999.0; 2]));
        assert!(!holds([0.1, 0.6], [f64::NAN; 2]));
    }
}
