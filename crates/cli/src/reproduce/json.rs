//! `tofsim.reproduce/1`.

use serde_json::{Value, json};

use super::finding::{Finding, tally};
use super::verdict::RULE;

/// Returns the object, without the record.
pub fn json(findings: &[Finding], quick: bool) -> Value {
    let [same, differs, none] = tally(findings).map(|(_, count)| count);
    json!({
        "schema": "tofsim.reproduce/1",
        "quick": quick,
        "rule": RULE,
        "same": same,
        "differs": differs,
        "cannot_be_reproduced": none,
        "items": findings,
    })
}
