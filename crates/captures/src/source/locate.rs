//! Position of the first error in a VCD, found with a second library because the waveform library does not report it.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use vcd::{Command, IdCode, Parser, ScopeItem};

use tofsim::error::{Error, Input};

/// Adds the line of the first error in the file to an error, if one is found.
pub(super) fn located(path: &Path, error: Error) -> Error {
    let Error::Input(input) = error else { return error };
    match (&input.place, fault(path)) {
        (None, Some((line, expected))) => Input::new(&input.source, expected).at(line, 1).into(),
        _ => Error::Input(input),
    }
}

/// Returns line and text of the first error.
fn fault(path: &Path) -> Option<(usize, String)> {
    let mut parser = Parser::new(BufReader::new(File::open(path).ok()?));
    let header = match parser.parse_header() {
        Ok(header) => header,
        Err(error) => return Some((parser.line() as usize, reason(&error))),
    };
    let mut widths = HashMap::new();
    declared(&header.items, &mut widths);
    while let Some(command) = parser.next() {
        let line = parser.line() as usize;
        match command {
            Err(error) => return Some((line, reason(&error))),
            Ok(Command::ChangeVector(id, value)) => match widths.get(&id) {
                Some(&width) if value.len() > width as usize => {
                    let count = value.len();
                    return Some((line, format!("expected {width} bits at most, not {count}")));
                }
                _ => {}
            },
            Ok(_) => {}
        }
    }
    None
}

fn declared(items: &[ScopeItem], widths: &mut HashMap<IdCode, u32>) {
    for item in items {
        match item {
            ScopeItem::Var(var) => {
                widths.insert(var.code, var.size);
            }
            ScopeItem::Scope(scope) => declared(&scope.items, widths),
            _ => {}
        }
    }
}

/// Returns the library's message without the line number at its start.
fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}
