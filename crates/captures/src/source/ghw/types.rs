//! Types of a GHW file: what determines names, widths and encodings of its signals.

use super::super::span::{Checked, Fault, Span, at_most};
use super::range::Range;

/// Largest nesting depth of types.
const DEEPEST: u32 = 256;
/// Limit of the steps for a name, per byte of the file.
const STEPS: u64 = 64;
/// Literals of `std_ulogic` and of `bit`, without quotes, in lower case.
const NINE: &[u8] = b"ux01zwlh-";
const TWO: &[u8] = b"01";

/// Encoding of a scalar signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    /// Position in `std_ulogic`.
    Nine,
    /// Position of a literal, with its width [bits].
    Literal(u32),
    /// Number, with its width [bits].
    Number(u32),
    Real,
}

impl Scalar {
    /// Returns whether an array of it is a vector of bits; `bit` is a literal of one bit.
    fn is_bit(self, literals: &[usize]) -> bool {
        self == Scalar::Nine || (self == Scalar::Literal(1) && literals.is_empty())
    }
}

/// Structure of a type.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    /// A scalar, with the strings of its literals if it is an enumeration other than `std_ulogic` and `bit`.
    Scalar(Scalar, Vec<usize>),
    /// An array of a type, with its ranges if they are known.
    Array(usize, Dimensions),
    /// Names and types of the fields.
    Record(Vec<(usize, usize)>),
    /// Another name of a type, or a subtype of a scalar.
    Alias(usize),
}

/// Dimensions of an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Dimensions {
    /// Their number.
    Open(u64),
    Known(Vec<Range>),
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

    /// Parses the section of types; `strings` are those of the file.
    pub(super) fn section(&mut self, file: &mut Span, strings: &[String]) -> Checked<()> {
        file.take(4)?;
        let count = file.items("types")?;
        self.most = (file.left() + file.place() as u64).saturating_mul(STEPS);
        for number in 1..=count {
            let form = self.form(file, strings);
            let form = form.map_err(|fault| fault.within(&format!("type {number}")))?;
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

    /// Returns the structure of a type that is no alias.
    pub(super) fn resolved(&self, index: usize) -> &Form {
        &self.types[self.base(index)].form
    }

    /// Returns the encoding of the elements if an array of them is a vector of bits.
    pub(super) fn bit(&self, element: usize) -> Option<Scalar> {
        match self.resolved(element) {
            Form::Scalar(scalar, literals) if scalar.is_bit(literals) => Some(*scalar),
            _ => None,
        }
    }

    fn base(&self, index: usize) -> usize {
        if let Form::Alias(base) = self.types[index].form { base } else { index }
    }

    fn form(&mut self, file: &mut Span, strings: &[String]) -> Checked<Form> {
        let kind = file.byte()?;
        file.number()?;
        Ok(match kind {
            22 | 23 => {
                let literals = (0..file.count("literals")?).map(|_| string(file, strings));
                enumeration(literals.collect::<Checked<_>>()?, strings)
            }
            25 => Form::Scalar(Scalar::Number(32), Vec::new()),
            26 => Form::Scalar(Scalar::Number(64), Vec::new()),
            27 => Form::Scalar(Scalar::Real, Vec::new()),
            28 | 29 => {
                let units = if self.version == 0 { 0 } else { file.count("units")? };
                for _ in 0..units {
                    file.number()?;
                    file.signed()?;
                }
                Form::Scalar(Scalar::Number(if kind == 28 { 32 } else { 64 }), Vec::new())
            }
            34 => {
                let base = self.of(file)?;
                Range::parse(file)?;
                Form::Alias(self.base(base))
            }
            31 => self.array(file)?,
            32 => {
                let count = file.count("fields")?;
                let fields = (0..count).map(|_| Ok((string(file, strings)?, self.of(file)?)));
                Form::Record(fields.collect::<Checked<_>>()?)
            }
            35 | 38 => {
                let base = self.of(file)?;
                self.bounded(file, base)?
            }
            37 | 39 => Form::Alias(self.base(self.of(file)?)),
            kind => return Err(Fault::value("kind", kind.into(), "is none that can be read")),
        })
    }

    /// Parses an array, whose ranges a subtype states.
    fn array(&self, file: &mut Span) -> Checked<Form> {
        let element = self.of(file)?;
        let dimensions = file.count("dimensions")?;
        if dimensions == 0 {
            return Err(Fault::value("dimensions", dimensions, "expected 1 or more"));
        }
        for _ in 0..dimensions {
            self.of(file)?;
        }
        Ok(Form::Array(element, Dimensions::Open(dimensions)))
    }

    /// Parses the ranges of a type's arrays without a length.
    fn bounded(&mut self, file: &mut Span, base: usize) -> Checked<Form> {
        let base = self.base(base);
        match self.types[base].form.clone() {
            Form::Array(_, Dimensions::Known(_)) => Ok(Form::Alias(base)),
            Form::Array(element, Dimensions::Open(count)) => {
                let ranges = (0..count).map(|_| Range::parse(file)).collect::<Checked<_>>()?;
                let element = self.bounded_part(file, element)?;
                Ok(Form::Array(element, Dimensions::Known(ranges)))
            }
            Form::Record(_) if self.types[base].is_whole => Ok(Form::Alias(base)),
            Form::Record(fields) => {
                let fields = fields
                    .into_iter()
                    .map(|(name, field)| Ok((name, self.bounded_part(file, field)?)));
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
        let (parts, times, has_range): (Vec<&Type>, u64, bool) = match &form {
            Form::Scalar(..) => (Vec::new(), 1, true),
            Form::Array(element, Dimensions::Open(_)) => (vec![part(*element)], u64::MAX, false),
            Form::Array(element, Dimensions::Known(ranges)) => {
                let product = |product: u64, range: &Range| product.saturating_mul(range.length());
                (vec![part(*element)], ranges.iter().fold(1, product), true)
            }
            Form::Record(fields) => {
                (fields.iter().map(|&(_, field)| part(field)).collect(), 1, true)
            }
            Form::Alias(base) => (vec![part(*base)], 1, true),
        };
        let sum = |of: fn(&Type) -> u64| {
            let sum = parts.iter().fold(0u64, |sum, part| sum.saturating_add(of(part)));
            sum.saturating_mul(times)
        };
        let is_scalar = matches!(form, Form::Scalar(..));
        let signals = sum(|part| part.signals).max(is_scalar.into());
        let steps = sum(|part| part.steps).saturating_add(1);
        let depth = 1 + parts.iter().map(|part| part.depth).max().unwrap_or(0);
        at_most("types within each other", depth.into(), DEEPEST.into())?;
        let is_whole = has_range && parts.iter().all(|part| part.is_whole);
        self.types.push(Type { form, signals, steps, depth, is_whole });
        Ok(())
    }
}

/// Parses a reference to a string, and returns its index; 0 is no name.
pub(super) fn string(file: &mut Span, strings: &[String]) -> Checked<usize> {
    let number = at_most("string", file.number()?, strings.len() as u64 - 1)?;
    Ok(number as usize)
}

/// Returns the structure of an enumeration with the given literals.
fn enumeration(literals: Vec<usize>, strings: &[String]) -> Form {
    let is = |values: &[u8]| {
        let same = |(&literal, value): (&usize, &u8)| {
            strings[literal].trim_matches('\'').as_bytes().to_ascii_lowercase() == [*value]
        };
        literals.len() == values.len() && literals.iter().zip(values).all(same)
    };
    if is(NINE) {
        return Form::Scalar(Scalar::Nine, Vec::new());
    }
    if is(TWO) {
        return Form::Scalar(Scalar::Literal(1), Vec::new());
    }
    let last = literals.len().saturating_sub(1).max(1);
    Form::Scalar(Scalar::Literal(usize::BITS - last.leading_zeros()), literals)
}
