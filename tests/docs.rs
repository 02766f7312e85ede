//! The documents say what the code does: port tables in `docs/model.md`, the table of effects in `docs/accuracy.md`.
//!
//! `UPDATE_DOCS=1 cargo test -p tofsim --test simulator docs` writes the tables anew.

use std::fmt::Write;
use std::fs;

use tofsim::hierarchy::{Entry, Kind, TOP, every_entry_of};
use tofsim::kernel::sizes::Sizes;
use tofsim::scenario::effects::{Effect, Method};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Begin and end of a module's table in the text.
const BEGIN: &str = "<!-- ports: ";
const END: &str = "<!-- end -->";

fn table(module: &str, entries: &[Entry]) -> String {
    let mut rows = String::from("| name | width | | meaning |\n|---|---|---|---|\n");
    let mut found = false;
    for entry in entries.iter().filter(|entry| below_top(entry) == module) {
        let name = entry.signal.name.as_str();
        found = true;
        if ["clk", "clk_sys", "clk_laser", "rst", "rst_laser"].contains(&name)
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

/// The module of an entry: `tof_top`, or its path below that.
fn below_top(entry: &Entry) -> &str {
    entry.scope.strip_prefix("tof_top.").unwrap_or(TOP)
}

/// The text with a paragraph, and a place for the table, for each module that has none: after the
/// module before it.
fn with_every_module(mut text: String, entries: &[Entry]) -> String {
    let mut modules: Vec<_> = entries.iter().map(below_top).collect();
    modules.dedup();
    // What it is stands where its twin is.
    modules.retain(|module| !["reset_sync_laser", "second_bank"].contains(module));
    let place = |text: &str, module| text.find(&format!("{BEGIN}{module} -->"));
    for pair in modules.windows(2).filter(|pair| pair[0] != TOP) {
        let [before, module] = [pair[0], pair[1]];
        if place(&text, module).is_none() {
            let begin = place(&text, before).unwrap();
            let end = begin + text[begin..].find(END).unwrap() + END.len();
            let name = module.rsplit('.').next().unwrap();
            let source = fs::read_to_string(format!("{ROOT}/src/firmware/{name}.rs")).unwrap();
            let says = source.lines().next().unwrap().trim_start_matches("//! ");
            let (first, rest) = says.split_at(1);
            let says = first.to_lowercase() + rest;
            text.insert_str(end, &format!("\n\n`{name}`: {says}\n\n{BEGIN}{module} -->\n{END}"));
        }
    }
    text
}

#[test]
fn the_port_tables_are_those_of_the_code() {
    let model = format!("{ROOT}/docs/model.md");
    let old = fs::read_to_string(&model).unwrap();
    // With the ports that only a TDC with a calibration, and only an array has.
    let (columns, banks) = (2, 2);
    let entries = every_entry_of(&Sizes { calibrates: true, columns, banks, ..Sizes::default() });
    let places = with_every_module(old.clone(), &entries);
    let mut parts = places.split(BEGIN);
    let mut new = parts.next().unwrap().to_owned();
    for part in parts {
        let (module, rest) = part.split_once(" -->").unwrap();
        let (_, rest) = rest.split_once(END).unwrap();
        write!(new, "{BEGIN}{module} -->\n\n{}\n{END}{rest}", table(module, &entries)).unwrap();
    }
    assert_or_update("docs/model.md", &old, &new);
}

/// The table of effects: keys, what they invalidate and from which value on, and why.
fn effects() -> String {
    let mut rows = String::from("| keys | invalidate | because |\n|---|---|---|\n");
    for effect in Effect::ALL {
        let keys: Vec<_> = effect.keys().iter().map(|key| format!("`{}`", key.name)).collect();
        let broken = Method::ALL.into_iter().filter_map(|method| match effect.limit(method)? {
            _ if method == Method::IndependentShots => None,
            0.0 => Some(method.name().to_owned()),
            limit => Some(format!("{} (above {limit})", method.name())),
        });
        let broken = broken.collect::<Vec<_>>().join(", ");
        writeln!(rows, "| {} | {broken} | {} |", keys.join(", "), effect.why()).unwrap();
    }
    rows
}

#[test]
fn the_table_of_effects_is_that_of_the_code() {
    let old = fs::read_to_string(format!("{ROOT}/docs/accuracy.md")).unwrap();
    let (before, rest) = old.split_once("<!-- effects -->").unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let new = format!("{before}<!-- effects -->\n\n{}\n{END}{after}", effects());
    assert_or_update("docs/accuracy.md", &old, &new);
}

/// Writes a document anew if `UPDATE_DOCS` is set, or fails if it is out of date.
fn assert_or_update(document: &str, old: &str, new: &str) {
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(format!("{ROOT}/{document}"), new).unwrap();
    } else {
        let how = "UPDATE_DOCS=1 cargo test -p tofsim --test simulator docs";
        assert!(old == new, "{document} is out of date: {how}");
    }
}
