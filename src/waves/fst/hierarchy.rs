//! Scopes, names and widths of an FST file, and what else it says of them.

use std::io::{self, Write};

use crate::hierarchy::{Entry, IDS, Kind};

use super::super::dump::signal::{DumpKind, DumpSignal};
use super::super::dump::tables::Tables;
use super::super::scopes::{Element, elements, nested};
use super::super::sources::ScopeSources;
use super::super::states::StateTables;
use super::attributes;
use super::blocks::{Block, long, number};

/// Start of a scope.
const SCOPE: u8 = 254;
/// End of the current scope.
const UP: u8 = 255;
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
    /// Creates the hierarchy of `entries`, with comments on the file.
    pub(super) fn new(entries: &[Entry], comments: &[String]) -> Self {
        let mut hierarchy = Hierarchy::with_comments(IDS, comments);
        let (mut sources, tables) = (ScopeSources::default(), StateTables::of(entries));
        let mut texts = tables.texts().peekable();
        for element in elements(entries) {
            let bytes = &mut hierarchy.spelled;
            match element {
                Element::Enter(name) => {
                    let source = sources.enter(name);
                    attributes::source(bytes, &source);
                    hierarchy.enter(name, source.component);
                }
                Element::Leave => {
                    sources.leave();
                    bytes.push(UP);
                }
                Element::Signal(entry) => {
                    attributes::comment(bytes, &entry.signal.meaning());
                    attributes::value_type(bytes, &entry.signal.type_text());
                    if let Some(table) = tables.number(&entry.signal) {
                        // GTKWave gives a new table to the next variable.
                        if let Some((number, text)) = texts.next_if(|next| next.0 == table) {
                            attributes::states(bytes, &text, number);
                        }
                        attributes::states(bytes, "", table);
                    }
                    hierarchy.name(entry);
                }
            }
        }
        hierarchy
    }

    /// Creates the hierarchy of any signals, whose ids are below `ids`, with comments on the file.
    pub(super) fn of(signals: &[DumpSignal], ids: usize, comments: &[String]) -> Self {
        let mut hierarchy = Hierarchy::with_comments(ids, comments);
        let mut tables = Tables::default();
        for element in nested(signals, DumpSignal::scopes) {
            let bytes = &mut hierarchy.spelled;
            match element {
                Element::Enter(name) => hierarchy.enter(name, ""),
                Element::Leave => bytes.push(UP),
                Element::Signal(signal) => {
                    if let Some(known) = &signal.description {
                        attributes::comment(bytes, &known.meaning);
                        attributes::value_type(bytes, &known.value_type);
                    }
                    if let Some((table, text)) = tables.of(signal) {
                        if let Some(text) = text {
                            attributes::states(bytes, &text, table);
                        }
                        attributes::states(bytes, "", table);
                    }
                    hierarchy.signal(signal);
                }
            }
        }
        hierarchy
    }

    /// Creates an empty hierarchy.
    fn with_comments(ids: usize, comments: &[String]) -> Self {
        let mut spelled = Vec::new();
        comments.iter().for_each(|text| attributes::comment(&mut spelled, text));
        Hierarchy { signals: vec![None; ids], spelled, ..Hierarchy::default() }
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

    /// Enters a scope that is an instance of a module, if that has a name.
    fn enter(&mut self, name: &str, component: &str) {
        self.spelled.extend([SCOPE, MODULE]);
        self.text(name);
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
