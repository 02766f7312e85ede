//! Types of a GHW file, as far as they determine the number of signals of a name.

use super::super::span::{Checked, Fault, Span, at_most};

/// Largest nesting depth of types.
const DEEPEST: u32 = 256;
/// Limit of the library's steps for a name, per byte of the file.
const STEPS: u64 = 64;

/// Structure of a type.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    /// An enumeration.
    Literals,
    /// A number, with the number of values in its range if it has one.
    Number(Option<u64>),
    Real,
    /// An array of a type, with its length if it is known.
    Array(usize, Option<u64>),
    Record(Vec<usize>),
    /// Another name of a type.
    Alias(usize),
}

/// A type with derived properties.
#[derive(Clone, Debug)]
struct Type {
    form: Form,
    /// Number of signals of an object of this type.
    signals: u64,
    /// Number of steps to visit them.
    steps: u64,
    depth: u32,
    /// Whether all its arrays have a known length.
    is_whole: bool,
}

/// Types of a file, in order.
pub(super) struct Types {
    version: u8,
    types: Vec<Type>,
    /// Index of each type that has a number in the file; anonymous types have none.
    numbered: Vec<usize>,
    /// Limit of the steps for a name.
    most: u64,
}

impl Types {
    pub(super) fn new(version: u8) -> Types {
        Types { version, types: Vec::new(), numbered: Vec::new(), most: 0 }
    }

    /// Parses the section of types.
    pub(super) fn section(&mut self, file: &mut Span) -> Checked<()> {
        file.take(4)?;
        let count = file.items("types")?;
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

    /// Parses a reference to a type, and returns the type's index.
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

    /// Returns the number of signals of a name of this type; [`u64::MAX`] if visiting them takes too many steps.
    pub(super) fn signals(&self, index: usize) -> u64 {
        let found = &self.types[index];
        if found.steps > self.most { u64::MAX } else { found.signals }
    }

    /// Skips a value of this type.
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
            31 => self.array(file)?,
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

    fn array(&self, file: &mut Span) -> Checked<Form> {
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
        Ok(Form::Array(element, length))
    }

    /// Parses the ranges of a type's arrays without a length.
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

    /// Parses the ranges of an element or a field, which becomes an anonymous type.
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

/// Parses a range, and returns its number of values.
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
