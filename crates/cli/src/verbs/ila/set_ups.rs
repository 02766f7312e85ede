//! `tofsim ila list`, `show` and `schema`: the set-ups there are, and what one may hold.

use schemars::schema_for;
use serde_json::json;

use tofsim::error::Result;
use tofsim_captures::compare::SignalMap;
use tofsim_captures::ila::setup::AnalyserSetupFile;
use tofsim_captures::ila::{AnalyserSetup, Overrides, builtin};

use crate::text::table::plain;
use crate::verbs::terminal::{print, print_json};

/// Prints the built-in set-ups and what they show.
pub fn list(as_json: bool) -> Result<()> {
    let mut rows = Vec::new();
    for (name, _) in builtin::SET_UPS {
        rows.push((*name, AnalyserSetup::load(name, Overrides::default())?.file));
    }
    if as_json {
        let object = |(name, file): &(&str, AnalyserSetupFile)| json!({ "name": name, "scenario": file.scenario, "description": file.description });
        return print_json(&rows.iter().map(object).collect());
    }
    let cells = |(name, file): (&str, AnalyserSetupFile)| {
        [name.to_owned(), file.scenario, file.description]
    };
    print(&format!("{}\n", plain(rows.into_iter().map(cells))))
}

/// Prints a set-up as a file to begin one's own with.
pub fn show(name: &str) -> Result<()> {
    match builtin::set_up(name) {
        Some(text) => print(text),
        None => AnalyserSetup::load(name, Overrides::default())
            .and_then(|_| tofsim::error::read_text(std::path::Path::new(name)))
            .and_then(|text| print(&text)),
    }
}

/// Prints the JSON Schema of set-ups, or of maps.
pub fn schema(of_maps: bool) -> Result<()> {
    let schema = if of_maps { schema_for!(SignalMap) } else { schema_for!(AnalyserSetupFile) };
    print(&format!("{:#}\n", schema.as_value()))
}
