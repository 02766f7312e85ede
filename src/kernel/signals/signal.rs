//! A signal of a module, as waveforms, vectors and documents describe it.

use crate::kernel::sizes::{Size, Sizes};

use super::unit::Unit;

/// Display format of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalFormat {
    /// One bit, or a word whose value is a pattern.
    Bits,
    /// A count or an address.
    Unsigned,
    /// A two's complement number with `fraction` bits after the point.
    Signed {
        /// Bits after the binary point.
        fraction: u32,
    },
    /// A state machine's state; the names in the order of their codes.
    State(&'static [&'static str]),
    /// The taps of a delay line.
    Taps,
}

/// Presentation of a signal in a viewer and a logic analyser.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// The heading under which a viewer shows it; empty: with all others.
    pub heading: &'static str,
    /// True if a viewer shows it as a curve as well.
    pub curve: bool,
    /// True if a logic analyser on the board would probe it, so that runs too long to compare everything
    /// compare it.
    pub probe: bool,
}

impl View {
    /// Nobody in particular.
    pub const NONE: View = View { heading: "", curve: false, probe: false };
}

/// Declaration of one or more signals by a field of [`signals!`](crate::signals); see [`Signal`].
#[allow(missing_docs, reason = "the fields are those of a signal")]
pub struct Declaration {
    pub name: &'static str,
    pub size: Option<Size>,
    pub count: Option<Size>,
    pub only_if: Option<Size>,
    pub output: bool,
    pub view: View,
    pub unit: Unit,
    pub doc: &'static str,
}

/// One signal of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its name, the same in Rust, Verilog and waveform.
    pub name: String,
    /// Its width [bits]; of a word whose width is a parameter, the most that it can be.
    pub width: u32,
    /// Its width, where elaboration decides it.
    pub size: Option<Size>,
    /// Its number in an array.
    pub element: u32,
    /// Number of elements of the array, where elaboration decides it.
    pub count: Option<Size>,
    /// Size that must not be zero for the port to exist.
    pub only_if: Option<Size>,
    /// Display format.
    pub format: SignalFormat,
    /// True if other modules may read it.
    pub output: bool,
    /// Presentation.
    pub view: View,
    /// Unit of its value.
    pub unit: Unit,
    pub doc: &'static str,
}

impl Signal {
    /// Creates the signal of a declaration, to be shaped by the type of its field.
    // A module has up to a hundred signals, and builds its list once.
    #[inline(never)]
    pub fn declared(declaration: &Declaration) -> Self {
        let Declaration { name, size, count, only_if, output, view, unit, doc } = *declaration;
        let (name, format) = (name.to_owned(), SignalFormat::Bits);
        Signal { name, width: 0, size, element: 0, count, only_if, format, output, view, unit, doc }
    }

    /// An output or wire of fixed width that nobody looks at first.
    pub fn plain(name: String, width: u32, format: SignalFormat, doc: &'static str) -> Self {
        let (size, count, only_if, output) = (None, None, None, false);
        let (view, unit) = (View::NONE, Unit::of(doc));
        Signal { name, width, size, element: 0, count, only_if, format, output, view, unit, doc }
    }

    /// Returns the bits after the binary point.
    pub fn fraction(&self) -> u32 {
        match self.format {
            SignalFormat::Signed { fraction: fraction @ 1.. } => fraction,
            _ => self.unit.fraction,
        }
    }

    /// Formats type, binary point and unit without blanks and dots, which some viewers take for an end, such as
    /// `signed/2^29[m]`.
    pub fn type_text(&self) -> String {
        let mut text = match self.format {
            SignalFormat::Bits if self.width == 1 => "bit",
            SignalFormat::Bits => "bits",
            SignalFormat::Unsigned => "unsigned",
            SignalFormat::Signed { .. } => "signed",
            SignalFormat::State(_) => "state",
            SignalFormat::Taps => "taps",
        }
        .to_owned();
        if self.fraction() > 0 {
            text += &format!("/2^{}", self.fraction());
        }
        let unit = match self.unit.length {
            Some(length) if length.fs() % 1000 > 0 => format!("{} fs", length.fs()),
            _ => self.unit.to_string(),
        };
        if !unit.is_empty() {
            text += &format!("[{}]", unit.replace(' ', "_"));
        }
        text
    }

    /// Formats a value as a number: a time in picoseconds, and any other in its unit.
    pub fn number_text(&self, bits: u64) -> String {
        let unused = u64::BITS - self.width;
        let integer = match self.format {
            SignalFormat::Signed { .. } => i128::from((bits << unused) as i64 >> unused),
            _ => bits.into(),
        };
        if self.fraction() == 0 && self.unit.length.is_none() {
            return integer.to_string();
        }
        let factor = self.unit.length.map_or(1.0, |length| 1e-3 * length.fs() as f64);
        let number = integer as f64 * f64::powi(0.5, self.fraction() as i32) * factor;
        let text = format!("{number:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }

    /// Returns the unit of [`number_text`](Signal::number_text); empty if it has none.
    pub fn number_unit(&self) -> &'static str {
        if self.unit.length.is_some() { "ps" } else { self.unit.name }
    }

    /// Returns its meaning: the documentation without the unit and without links.
    pub fn meaning(&self) -> String {
        Unit::meaning(self.doc).replace("[`", "`").replace("`]", "`")
    }

    /// Returns whether a port is one in a design of those sizes.
    pub fn is_shared(&self, sizes: &Sizes) -> bool {
        self.only_if.is_none_or(|size| sizes.of(size) > 0)
    }

    /// The signal as a design of those sizes has it, if it has it.
    pub fn fitted(self, sizes: &Sizes) -> Option<Self> {
        if self.count.is_some_and(|count| self.element >= sizes.of(count)) {
            return None;
        }
        let Some(size) = self.size else { return Some(self) };
        let width = sizes.of(size);
        let format = match (self.format, sizes.fraction(size)) {
            (SignalFormat::Unsigned, _) if width == 1 => SignalFormat::Bits,
            (SignalFormat::Signed { .. }, Some(fraction)) => SignalFormat::Signed { fraction },
            (format, _) => format,
        };
        (width > 0).then_some(Signal { width, format, ..self })
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::Time;

    use super::*;

    fn signal(format: SignalFormat, width: u32, doc: &'static str) -> Signal {
        let plain = Signal::plain("x".to_owned(), width, format, doc);
        Signal { unit: plain.unit.in_design(Time::from_fs(25_000), 4), ..plain }
    }

    #[test]
    fn a_type_has_binary_point_and_unit() {
        let depth = signal(SignalFormat::Signed { fraction: 29 }, 36, "The depth [m].");
        assert_eq!(depth.type_text(), "signed/2^29[m]");
        let strength = "S, 14 fraction bits [photons a shot].";
        let strength = signal(SignalFormat::Unsigned, 24, strength);
        assert_eq!(strength.type_text(), "unsigned/2^14[photons_a_shot]");
        assert_eq!(signal(SignalFormat::Bits, 1, "Reset.").type_text(), "bit");
    }

    #[test]
    fn numbers_are_in_their_unit_and_times_in_picoseconds() {
        let depth = signal(SignalFormat::Signed { fraction: 29 }, 36, "The depth [m].");
        assert_eq!((depth.number_text(0x1013_c199), depth.number_unit()), ("0.502412".into(), "m"));
        assert_eq!(depth.number_text(0xf_e000_0000), "-1");
        let time = signal(SignalFormat::Signed { fraction: 0 }, 17, "Time [units].");
        assert_eq!((time.number_text(33), time.number_unit()), ("51.5625".into(), "ps"));
        assert_eq!(time.number_text(0x1_ffff), "-1.5625");
        assert_eq!(time.type_text(), "signed/2^4[25_ps]");
        let unit = Unit::of("Time [bins].").in_design(Time::from_fs(12_500), 4);
        assert_eq!(Signal { unit, ..time }.type_text(), "signed[12500_fs]");
        let count = signal(SignalFormat::Unsigned, 16, "Word [hits].");
        assert_eq!((count.number_text(65_535), count.number_unit()), ("65535".into(), "hits"));
    }
}
