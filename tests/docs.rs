//! The documents say what the code does: port tables in `docs/model.md`.
//!
//! `UPDATE_DOCS=1 cargo test -p tofsim --test simulator docs` writes the tables anew.

use crate::common;
use std::fmt::Write;
use std::fs;

use tofsim::hierarchy::{Entry, Kind, entries};

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/model.md");

/// Entries of every module, those of the stand-ins too.
fn all_entries() -> Vec<Entry> {
    let mut all = Vec::new();
    let scenarios =
        ["kc705", "histogram_validation", "estimator_validation"].map(|name| (name, ""));
    for (scenario, key) in scenarios.into_iter().chain([("kc705", "estimator.kind=centroid")]) {
        let keys: &[&str] = if key.is_empty() { &[] } else { &[key] };
        for entry in entries(&common::setup(scenario, keys).params) {
            if !all.iter().any(|known: &Entry| known.path() == entry.path()) {
                all.push(entry);
            }
        }
    }
    all
}

fn table(module: &str, entries: &[Entry]) -> String {
    let scope = if module == "tof_top" { module.into() } else { format!("tof_top.{module}") };
    let mut rows = String::from("| name | width | | meaning |\n|---|---|---|---|\n");
    let mut found = false;
    for entry in entries.iter().filter(|entry| entry.scope == scope) {
        let name = entry.signal.name.as_str();
        found = true;
        if ["clk", "clk_125", "clk_250", "rst", "rst_250"].contains(&name)
            && entry.kind == Kind::Input
        {
            continue;
        }
        let direction = match entry.kind {
            Kind::Input => "in",
            Kind::Output => "out",
            Kind::Internal => "",
        };
        let (width, doc) = (entry.signal.width, entry.signal.doc);
        writeln!(rows, "| `{name}` | {width} | {direction} | {doc} |").unwrap();
    }
    assert!(found, "docs/model.md asks for the ports of {module}, which does not exist");
    rows
}

#[test]
fn the_port_tables_are_those_of_the_code() {
    let old = fs::read_to_string(MODEL).unwrap();
    let entries = all_entries();
    let mut new = String::new();
    let mut modules = Vec::new();
    let mut parts = old.split("<!-- ports: ");
    new += parts.next().unwrap();
    for part in parts {
        let (module, rest) = part.split_once(" -->").unwrap();
        let (_, rest) = rest.split_once("<!-- end -->").unwrap();
        write!(new, "<!-- ports: {module} -->\n\n{}\n<!-- end -->{rest}", table(module, &entries))
            .unwrap();
        modules.push(module.to_owned());
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(MODEL, &new).unwrap();
    }
    assert!(
        old == new || std::env::var_os("UPDATE_DOCS").is_some(),
        "docs/model.md is out of date: UPDATE_DOCS=1 cargo test -p tofsim --test simulator docs"
    );
    for entry in &entries {
        let module = entry.scope.strip_prefix("tof_top.").unwrap_or(&entry.scope);
        let twin = module == "reset_sync_250";
        assert!(
            twin || modules.iter().any(|known| known == module),
            "{module} is not in docs/model.md"
        );
    }
}
