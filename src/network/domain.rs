//! What a network was trained for.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the histograms of a training were drawn for, by keys of the scenario (`target.distance_m`).
/// What another scenario makes of the network is not known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Least and largest value of a key, in its unit; one twice where there was only one.
    pub ranges: BTreeMap<String, [f64; 2]>,
    /// Words and names.
    pub words: BTreeMap<String, String>,
}

/// Part of a value that decides nothing: what decimals lose in binary [1].
const ROUNDING: f64 = 1e-9;

/// Whether values from `found[0]` to `found[1]` lie within a range.
pub fn holds(range: [f64; 2], found: [f64; 2]) -> bool {
    let slack = |limit: f64| limit.abs() * ROUNDING;
    found[0] >= range[0] - slack(range[0]) && found[1] <= range[1] + slack(range[1])
}

/// A range in words: `0.1 to 0.6`, or the only value.
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
