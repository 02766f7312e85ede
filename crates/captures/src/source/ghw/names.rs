//! Names of a GHW file: the tree of scopes, and the signals of each name.

use std::sync::Arc;

use super::super::signals::WIDEST;
use super::super::span::{Checked, Fault, Span, at_most};
use super::range::Range;
use super::types::{Dimensions, Form, Scalar, Types, string};

/// Limit of the total length of all strings, which share prefixes [characters].
const CHARACTERS: u64 = 1 << 27;

/// A name, and the file's signals that it stands for, highest bit first.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    /// Scopes and records that it is part of, outermost first.
    pub(super) scopes: Arc<[String]>,
    /// Name in them.
    pub(super) own: String,
    /// Numbers of the file's signals, from 1.
    pub(super) signals: Vec<u32>,
    pub(super) scalar: Scalar,
    /// Indices of the highest and the lowest bit of a vector.
    pub(super) range: Option<[i64; 2]>,
    /// Strings of the literals of an enumeration.
    pub(super) literals: Vec<usize>,
}

/// Parses the section of strings; the first of them is empty.
pub(super) fn strings(file: &mut Span) -> Checked<Vec<String>> {
    file.take(4)?;
    let count = file.items("strings")?;
    file.take(4)?;
    let (mut text, mut total, mut strings) = (Vec::new(), 0, Vec::new());
    // The section's end has the form of another string.
    for _ in 0..=count {
        let mut last = file.byte()?;
        while last > 31 && !(128..=159).contains(&last) {
            text.push(last);
            last = file.byte()?;
        }
        total = at_most("characters of all strings", total + text.len() as u64, CHARACTERS)?;
        strings.push(text.iter().map(|&byte| char::from(byte)).collect());
        let (mut shared, mut shift) = (usize::from(last & 0x1f), 5);
        while last >= 128 {
            last = file.byte()?;
            shared |= usize::from(last & 0x1f) << shift;
            shift = 59.min(shift + 5);
        }
        text.truncate(shared);
    }
    strings.pop();
    strings.insert(0, String::new());
    Ok(strings)
}

/// Parser of the hierarchy.
pub(super) struct Names<'a> {
    types: &'a Types,
    strings: &'a [String],
    pub(super) variables: Vec<Variable>,
    /// Encoding of each of the file's signals.
    pub(super) scalars: Vec<Scalar>,
    scopes: Vec<String>,
    /// The scopes that have a name, once a signal needs them.
    path: Option<Arc<[String]>>,
}

impl<'a> Names<'a> {
    pub(super) fn new(types: &'a Types, strings: &'a [String]) -> Names<'a> {
        let (variables, scalars, scopes) = (Vec::new(), Vec::new(), Vec::new());
        Names { types, strings, variables, scalars, scopes, path: None }
    }

    /// Parses the section.
    pub(super) fn section(&mut self, file: &mut Span) -> Checked<()> {
        file.take(12)?;
        file.items("signals")?;
        loop {
            match file.byte()? {
                0 => return Ok(()),
                END_OF_SCOPE => {
                    self.path = None;
                    self.scopes.pop();
                }
                GENERATE_FOR => {
                    let name = self.name(file)?;
                    let iterator = self.iterator(file)?;
                    self.enter(format!("{name}({iterator})"));
                }
                // A process has no end of its scope.
                PROCESS => drop(file.number()?),
                kind if SCOPES.contains(&kind) => {
                    let name = self.name(file)?;
                    self.enter(name);
                }
                kind if SIGNALS.contains(&kind) => {
                    let name = self.name(file)?;
                    let found = self.types.of(file)?;
                    at_most("signals of a name", self.types.signals(found), file.left())?;
                    let scopes = self.scopes.iter().filter(|scope| !scope.is_empty());
                    let path = self.path.get_or_insert_with(|| scopes.cloned().collect());
                    let path = Arc::clone(path);
                    self.declare(&path, name, found, file)?;
                }
                kind => return Err(Fault::value("kind", kind.into(), "is none of GHDL's")),
            }
        }
    }

    fn enter(&mut self, name: String) {
        self.path = None;
        self.scopes.push(name);
    }

    fn name(&self, file: &mut Span) -> Checked<String> {
        Ok(self.strings[string(file, self.strings)?].clone())
    }

    /// Parses the value of a generate statement's iterator.
    fn iterator(&self, file: &mut Span) -> Checked<i64> {
        let index = self.types.of(file)?;
        match self.types.resolved(index) {
            Form::Scalar(Scalar::Nine | Scalar::Literal(_), _) => Ok(file.byte()?.into()),
            Form::Scalar(Scalar::Number(_), _) => file.signed(),
            _ => Err(Fault::of("iterator", "expected an enumeration or an integer")),
        }
    }

    /// Adds a name of a type, or the names of its elements and fields, and parses the numbers of their signals.
    fn declare(
        &mut self,
        scopes: &Arc<[String]>,
        own: String,
        index: usize,
        file: &mut Span,
    ) -> Checked<()> {
        let types = self.types;
        match types.resolved(index) {
            Form::Scalar(scalar, literals) => {
                let signals = vec![self.signal(file, *scalar)?];
                let literals = literals.clone();
                let (scopes, scalar, range) = (Arc::clone(scopes), *scalar, None);
                let variable = Variable { scopes, own, signals, scalar, range, literals };
                self.variables.push(variable);
                Ok(())
            }
            Form::Array(element, Dimensions::Known(ranges)) => {
                self.elements(scopes, own, (*element, ranges), file)
            }
            Form::Record(fields) => {
                let scopes: Arc<[String]> = scopes.iter().cloned().chain([own]).collect();
                fields.iter().try_for_each(|&(field, index)| {
                    self.declare(&scopes, self.strings[field].clone(), index, file)
                })
            }
            Form::Array(..) | Form::Alias(_) => Err(Fault::of("type", "expected one with ranges")),
        }
    }

    /// Adds the elements of an array; the last dimension of an array of bits is a vector.
    fn elements(
        &mut self,
        scopes: &Arc<[String]>,
        own: String,
        (element, ranges): (usize, &[Range]),
        file: &mut Span,
    ) -> Checked<()> {
        match (ranges, self.types.bit(element)) {
            ([], _) => self.declare(scopes, own, element, file),
            ([range], Some(scalar)) => {
                let length = at_most("width", range.length(), WIDEST.into())?;
                let signals = (0..length).map(|_| self.signal(file, scalar));
                let signals: Vec<u32> = signals.collect::<Checked<_>>()?;
                let (range, literals) = (Some([range.left, range.right]), Vec::new());
                if !signals.is_empty() {
                    let scopes = Arc::clone(scopes);
                    let variable = Variable { scopes, own, signals, scalar, range, literals };
                    self.variables.push(variable);
                }
                Ok(())
            }
            ([range, inner @ ..], _) => range.values().try_for_each(|value| {
                self.elements(scopes, format!("{own}[{value}]"), (element, inner), file)
            }),
        }
    }

    /// Parses the number of a signal, and sets its encoding.
    fn signal(&mut self, file: &mut Span, scalar: Scalar) -> Checked<u32> {
        let number = file.number()?;
        // Signals are numbered in the order in which they first appear.
        let most = self.scalars.len() as u64 + 1;
        let place = match at_most("signal", number, most)? {
            0 => return Err(Fault::value("signal", number, "expected 1 or more")),
            number => number as usize - 1,
        };
        match self.scalars.get(place) {
            None => self.scalars.push(scalar),
            Some(&first) if first == scalar => {}
            Some(_) => return Err(Fault::value("signal", number, "has another type elsewhere")),
        }
        Ok(number as u32)
    }
}

/// Kinds of entries in the hierarchy.
const END_OF_SCOPE: u8 = 15;
const GENERATE_FOR: u8 = 5;
const PROCESS: u8 = 13;
/// Kinds of scopes: block, generate, instance, package and generic.
const SCOPES: [u8; 5] = [3, 4, 6, 7, 14];
const SIGNALS: std::ops::RangeInclusive<u8> = 16..=21;
