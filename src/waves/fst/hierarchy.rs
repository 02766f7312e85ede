//! Scopes, names and widths of an FST file.

use std::io::{self, Write};

use crate::hierarchy::{Entry, IDS, Kind};

use super::super::dump::signal::{DumpKind, DumpSignal};
use super::super::dump::tables::Tables;
use super::super::scopes::{Element, elements, nested};
use super::blocks::{Block, long, number};

/// Start of a scope.
const SCOPE: u8 = 254;
/// End of the current scope.
const UP: u8 = 255;
/// Start and end of an attribute, and the kind that has tables of state names: miscellaneous, 7.
const ATTRIBUTE: [u8; 3] = [252, 0, 7];
/// Type of a scope.
const MODULE: u8 = 0;
/// Type of a variable that is driven.
const WIRE: u8 = 16;
/// Type of a variable that stores its value.
const REG: u8 = 5;

/// Type of a variable that has no value, only events.
const EVENT: u8 = 0;
/// Type of a variable in floating point.
const REAL: u8 = 3;
/// Type of a variable with text.
const TEXT: u8 = 21;
/// Size of a real number, which is its width in the hierarchy [bytes].
const REAL_BYTES: u32 = 8;
/// Widths of the initial values of a real number and of a text, as the geometry has them.
const REAL_WIDTH: usize = 0;
const TEXT_WIDTH: usize = 0xffff_ffff;

/// The hierarchy of a file.
#[derive(Default)]
pub(super) struct Hierarchy {
    /// Index of each id's signal in the file; `None` if it is not selected.
    pub(super) signals: Vec<Option<usize>>,
    /// Width of each signal [bits].
    pub(super) widths: Vec<usize>,
    pub(super) scopes: u64,
    /// Number of names, including aliases.
    pub(super) names: u64,
    /// Uncompressed contents of the block.
    spelled: Vec<u8>,
}

impl Hierarchy {
    /// Creates the hierarchy of `entries`.
    pub(super) fn new(entries: &[Entry]) -> Self {
        let mut hierarchy = Hierarchy { signals: vec![None; IDS], ..Hierarchy::default() };
        for element in elements(entries) {
            match element {
                Element::Enter(name) => hierarchy.enter(name),
                Element::Leave => hierarchy.spelled.push(UP),
                Element::Signal(entry) => hierarchy.name(entry),
            }
        }
        hierarchy
    }

    /// Creates the hierarchy of any signals, whose ids are below `ids`.
    pub(super) fn of(signals: &[DumpSignal], ids: usize) -> Self {
        let mut hierarchy = Hierarchy { signals: vec![None; ids], ..Hierarchy::default() };
        let mut tables = Tables::default();
        for element in nested(signals, DumpSignal::scopes) {
            match element {
                Element::Enter(name) => hierarchy.enter(name),
                Element::Leave => hierarchy.spelled.push(UP),
                Element::Signal(signal) => {
                    if let Some((table, text)) = tables.of(signal) {
                        if let Some(text) = text {
                            hierarchy.attribute(&text, table);
                        }
                        hierarchy.attribute("", table);
                    }
                    hierarchy.signal(signal);
                }
            }
        }
        hierarchy
    }

    /// Adds a table of states, or the table of the next variable.
    fn attribute(&mut self, text: &str, table: u64) {
        self.spelled.extend(ATTRIBUTE);
        self.text(text);
        number(&mut self.spelled, table);
    }

    fn signal(&mut self, signal: &DumpSignal) {
        let (variable, width, initial) = match signal.kind {
            DumpKind::Bits(width) => (WIRE, width, width as usize),
            DumpKind::Real => (REAL, REAL_BYTES, REAL_WIDTH),
            DumpKind::Text => (TEXT, 0, TEXT_WIDTH),
            DumpKind::Event => (EVENT, 1, 1),
        };
        let range = signal.range_text().map_or(String::new(), |range| format!(" {range}"));
        self.variable([variable, 0], &(signal.name.clone() + &range), width, (signal.id, initial));
    }

    fn enter(&mut self, name: &str) {
        self.spelled.extend([SCOPE, MODULE]);
        self.text(name);
        let component = "";
        self.text(component);
        self.scopes += 1;
    }

    fn name(&mut self, entry: &Entry) {
        let Entry { signal, kind, id, .. } = entry;
        let (variable, direction) = match kind {
            Kind::Internal => (REG, 0),
            Kind::Input => (WIRE, 1),
            Kind::Output => (WIRE, 2),
        };
        let name = match signal.width {
            1 => signal.name.to_string(),
            width => format!("{} [{}:0]", signal.name, width - 1),
        };
        self.variable([variable, direction], &name, signal.width, (*id, signal.width as usize));
    }

    /// Adds a variable of a type and a direction; `initial` is the width of the initial value of a new id.
    fn variable(&mut self, kind: [u8; 2], name: &str, width: u32, (id, initial): (usize, usize)) {
        self.spelled.extend(kind);
        self.text(name);
        number(&mut self.spelled, width.into());
        // The signal that it is another name of, from 1; 0 is a new one.
        number(&mut self.spelled, self.signals[id].map_or(0, |place| place as u64 + 1));
        if self.signals[id].is_none() {
            self.signals[id] = Some(self.widths.len());
            self.widths.push(initial);
        }
        self.names += 1;
    }

    fn text(&mut self, text: &str) {
        self.spelled.extend_from_slice(text.as_bytes());
        self.spelled.push(0);
    }

    pub(super) fn write(&self, file: &mut impl Write) -> io::Result<()> {
        let mut uncompressed = Vec::new();
        long(&mut uncompressed, self.spelled.len() as u64);
        let packed = lz4_flex::block::compress(&self.spelled);
        Block::Hierarchy.write(file, &[&uncompressed, &packed])?;

        let (mut counts, mut widths) = (Vec::new(), Vec::new());
        self.widths.iter().for_each(|&width| number(&mut widths, width as u64));
        long(&mut counts, widths.len() as u64);
        long(&mut counts, self.widths.len() as u64);
        Block::Geometry.write(file, &[&counts, &widths])
    }
}
