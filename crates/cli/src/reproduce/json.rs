//! `tofsim.reproduce/1`.

use serde_json::{Value, json};

use super::results::{Made, tally};
use super::verdict::RULE;

/// The object, without the record.
pub fn json(made: &[Made], quick: bool) -> Value {
    let items: Vec<_> = made.iter().map(item).collect();
    let [same, differs, none] = tally(made).map(|(_, count)| count);
    json!({
        "schema": "tofsim.reproduce/1",
        "quick": quick,
        "rule": RULE,
        "same": same,
        "differs": differs,
        "cannot_be_reproduced": none,
        "items": items,
    })
}

fn item(made: &Made) -> Value {
    let finding = &made.finding;
    json!({
        "id": made.item.id,
        "title": made.item.title,
        "verdict": made.verdict,
        "reason": finding.reason,
        "command": made.command,
        "other_commands": finding.commands,
        "rows": finding.rows,
    })
}
