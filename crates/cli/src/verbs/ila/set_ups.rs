//! `tofsim ila list`, `show` and `schema`: the set-ups there are, and what one may hold.

use schemars::schema_for;
use serde_json::json;

use tofsim::error::Result;
use tofsim_captures::compare::SignalMap;
use tofsim_captures::ila::setup::AnalyserSetupFile;
use tofsim_captures::ila::{AnalyserSetup, builtin};

use crate::text::table::plain;
use crate::verbs::terminal::{print, print_json};

/// Prints the built-in set-ups and what they show.
pub fn list(as_json: bool) -> Result<()> {
    let mut rows = Vec::new();
    for (name, _) in builtin::SET_UPS {
        let file = AnalyserSetup::load(name)?.file;
        rows.push([name.to_string(), file.scenario, file.description]);
    }
    if as_json {
        let object = |[name, scenario, description]: &[String; 3]| json!({ "name": name, "scenario": scenario, "description": description });
        return print_json(&rows.iter().map(object).collect());
    }
    print(&format!("{}\n", plain(rows)))
}

/// Prints a set-up as a file to begin one's own with.
pub fn show(name: &str) -> Result<()> {
    match builtin::set_up(name) {
        Some(text) => print(text),
        None => AnalyserSetup::load(name)
            .and_then(|_| tofsim::error::read_text(std::path::Path::new(name)))
            .and_then(|text| print(&text)),
    }
}

/// Prints the JSON Schema of set-ups, or of maps.
pub fn schema(of_maps: bool) -> Result<()> {
    let schema = if of_maps { schema_for!(SignalMap) } else { schema_for!(AnalyserSetupFile) };
    print(&format!("{:#}\n", schema.as_value()))
}
