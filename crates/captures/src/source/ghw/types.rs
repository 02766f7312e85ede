//! The types of a GHW file, as far as they say how many signals a name has.

use super::super::span::{Checked, Fault, Span, at_most};
use super::words::count;

/// Deepest that types may be within each other.
const DEEPEST: u32 = 256;
/// Steps that the library may take for a name, for each byte of the file.
const STEPS: u64 = 64;

/// What a type is.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    /// An enumeration.
    Literals,
    /// A number, whether it has a range, and how many values that is.
    Number(Option<u64>),
    Real,
    /// Elements of a type, so many if that is said.
    Array(usize, Option<u64>),
    Record(Vec<usize>),
    /// The same as another.
    Alias(usize),
}

/// A type, and what comes of it.
#[derive(Clone, Debug)]
struct Type {
    form: Form,
    /// Signals that an object of it has.
    signals: u64,
    /// Steps to go through them.
    steps: u64,
    depth: u32,
    /// Whether all its arrays say how long they are.
    is_whole: bool,
}

/// The types of a file, in its order.
pub(super) struct Types {
    version: u8,
    types: Vec<Type>,
    /// Index of each that has a number in the file; those within others have none.
    numbered: Vec<usize>,
    /// Steps for a name at most.
    most: u64,
}

impl Types {
    pub(super) fn new(version: u8) -> Types {
        Types { version, types: Vec::new(), numbered: Vec::new(), most: 0 }
    }

    /// Reads them.
    pub(super) fn section(&mut self, file: &mut Span, is_big: bool) -> Checked<()> {
        file.take(4)?;
        let count = count(file, is_big, "types")?;
        self.most = (file.left() + file.place() as u64).saturating_mul(STEPS);
        for number in 1..=count {
            let form = self.form(file).map_err(|fault| fault.within(&format!("type {number}")))?;
            self.add(form)?;
            self.numbered.push(self.types.len() - 1);
        }
        match file.byte()? {
            0 => Ok(()),
            end => Err(Fault::value("end", end.into(), "expected 0")),
        }
    }

    /// The index of a type that has been read.
    pub(super) fn of(&self, file: &mut Span) -> Checked<usize> {
        let number = file.number()?;
        match number {
            0 => Err(Fault::value("type", number, "expected 1 or more")),
            _ => {
                let number = at_most("type", number, self.numbered.len() as u64)?;
                Ok(self.numbered[number as usize - 1])
            }
        }
    }

    /// How many signals a name of that type has; more than there can be if it takes too long to go
    /// through them.
    pub(super) fn signals(&self, index: usize) -> u64 {
        let found = &self.types[index];
        if found.steps > self.most { u64::MAX } else { found.signals }
    }

    /// Passes over a value of that type.
    pub(super) fn value(&self, file: &mut Span, index: usize) -> Checked<()> {
        match self.types[self.base(index)].form {
            Form::Literals => drop(file.byte()?),
            Form::Number(_) => drop(file.signed()?),
            Form::Real => drop(file.take(8)?),
            _ => return Err(Fault::of("value", "expected a scalar")),
        }
        Ok(())
    }

    fn base(&self, index: usize) -> usize {
        if let Form::Alias(base) = self.types[index].form { base } else { index }
    }

    fn form(&mut self, file: &mut Span) -> Checked<Form> {
        let kind = file.byte()?;
        file.number()?;
        Ok(match kind {
            22 | 23 => {
                for _ in 0..file.count("literals")? {
                    file.number()?;
                }
                Form::Literals
            }
            25 | 26 => Form::Number(None),
            27 => Form::Real,
            28 | 29 => {
                let units = if self.version == 0 { 0 } else { file.count("units")? };
                for _ in 0..units {
                    file.number()?;
                    file.signed()?;
                }
                Form::Number(None)
            }
            34 => {
                let base = self.of(file)?;
                let length = range(file)?;
                match self.types[self.base(base)].form {
                    Form::Literals => Form::Alias(self.base(base)),
                    Form::Real => Form::Real,
                    _ => Form::Number(Some(length)),
                }
            }
            31 => {
                let element = self.of(file)?;
                let dimensions = file.count("dimensions")?;
                if dimensions != 1 {
                    return Err(Fault::value("dimensions", dimensions, "expected 1"));
                }
                let index = self.of(file)?;
                let length = match self.types[self.base(index)].form {
                    Form::Literals => Some(u64::MAX),
                    Form::Number(length) => length,
                    _ => None,
                };
                Form::Array(element, length)
            }
            32 => {
                let count = file.count("fields")?;
                let mut field = |_| {
                    file.number()?;
                    self.of(file)
                };
                Form::Record((0..count).map(&mut field).collect::<Checked<_>>()?)
            }
            35 | 38 => {
                let base = self.of(file)?;
                self.bounded(file, base)?
            }
            37 => {
                let base = self.of(file)?;
                match self.types[self.base(base)].form {
                    Form::Array(element, _) => Form::Array(element, None),
                    _ => return Err(Fault::of("base", "expected an array")),
                }
            }
            kind => return Err(Fault::value("kind", kind.into(), "is none that can be read")),
        })
    }

    /// A type with the ranges of those of its arrays that have none.
    fn bounded(&mut self, file: &mut Span, base: usize) -> Checked<Form> {
        let base = self.base(base);
        match self.types[base].form.clone() {
            Form::Array(element, _) => {
                let length = range(file)?;
                let element = self.bounded_part(file, element)?;
                Ok(Form::Array(element, Some(length)))
            }
            Form::Record(_) if self.types[base].is_whole => Ok(Form::Alias(base)),
            Form::Record(fields) => {
                let fields = fields.into_iter().map(|field| self.bounded_part(file, field));
                Ok(Form::Record(fields.collect::<Checked<_>>()?))
            }
            _ => Err(Fault::of("base", "expected an array or a record")),
        }
    }

    /// The same of an element or a field, which becomes a type of its own.
    fn bounded_part(&mut self, file: &mut Span, part: usize) -> Checked<usize> {
        if self.types[part].is_whole {
            return Ok(part);
        }
        let form = self.bounded(file, part)?;
        self.add(form)?;
        Ok(self.types.len() - 1)
    }

    fn add(&mut self, form: Form) -> Checked<()> {
        let part = |index: usize| &self.types[index];
        let (parts, times): (Vec<&Type>, u64) = match &form {
            Form::Literals | Form::Number(_) | Form::Real => (Vec::new(), 1),
            Form::Array(element, length) => (vec![part(*element)], length.unwrap_or(u64::MAX)),
            Form::Record(fields) => (fields.iter().map(|&field| part(field)).collect(), 1),
            Form::Alias(base) => (vec![part(*base)], 1),
        };
        let sum = |of: fn(&Type) -> u64| {
            let sum = parts.iter().fold(0u64, |sum, part| sum.saturating_add(of(part)));
            sum.saturating_mul(times)
        };
        let is_scalar = parts.is_empty() && !matches!(form, Form::Record(_));
        let signals = sum(|part| part.signals).max(is_scalar.into());
        let steps = sum(|part| part.steps).saturating_add(1);
        let depth = 1 + parts.iter().map(|part| part.depth).max().unwrap_or(0);
        at_most("types within each other", depth.into(), DEEPEST.into())?;
        let has_range = match form {
            Form::Array(_, length) | Form::Number(length) => length.is_some(),
            _ => true,
        };
        let is_whole = has_range && parts.iter().all(|part| part.is_whole);
        self.types.push(Type { form, signals, steps, depth, is_whole });
        Ok(())
    }
}

/// How many values a range has.
fn range(file: &mut Span) -> Checked<u64> {
    let head = file.byte()?;
    let falls = head & 0x80 != 0;
    let (left, right) = match head & 0x7f {
        22 | 23 => (file.byte()?.into(), file.byte()?.into()),
        25 | 26 | 28 | 29 => (file.signed()?, file.signed()?),
        27 => {
            file.take(16)?;
            return Ok(0);
        }
        kind => return Err(Fault::value("a range's kind", kind.into(), "is none of GHDL's")),
    };
    let (low, high) = if falls { (right, left) } else { (left, right) };
    let length = i128::from(high) - i128::from(low) + 1;
    Ok(u64::try_from(length.max(0)).unwrap_or(u64::MAX))
}
