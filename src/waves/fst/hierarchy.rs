//! Scopes, names and widths of an FST file.

use std::io::{self, Write};

use crate::hierarchy::{Entry, IDS, Kind};

use super::super::scopes::{Element, elements};
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

/// The hierarchy of a file.
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
        let (signals, widths, spelled) = (vec![None; IDS], Vec::new(), Vec::new());
        let mut hierarchy = Hierarchy { signals, widths, scopes: 0, names: 0, spelled };
        for element in elements(entries) {
            match element {
                Element::Enter(name) => hierarchy.enter(name),
                Element::Leave => hierarchy.spelled.push(UP),
                Element::Signal(entry) => hierarchy.name(entry),
            }
        }
        hierarchy
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
        self.spelled.extend([variable, direction]);
        match signal.width {
            1 => self.text(&signal.name),
            width => self.text(&format!("{} [{}:0]", signal.name, width - 1)),
        }
        number(&mut self.spelled, signal.width.into());
        // The signal that it is another name of, from 1; 0 is a new one.
        number(&mut self.spelled, self.signals[*id].map_or(0, |place| place as u64 + 1));
        if self.signals[*id].is_none() {
            self.signals[*id] = Some(self.widths.len());
            self.widths.push(signal.width as usize);
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
