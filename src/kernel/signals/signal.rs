//! A signal of a module, as waveforms, vectors and documents describe it.

use crate::kernel::sizes::{Size, Sizes};

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
    pub doc: &'static str,
}

impl Signal {
    /// Creates the signal of a declaration, to be shaped by the type of its field.
    // A module has up to a hundred signals, and builds its list once.
    #[inline(never)]
    pub fn declared(declaration: &Declaration) -> Self {
        let Declaration { name, size, count, only_if, output, view, doc } = *declaration;
        let plain = Signal::plain(name.to_owned(), 0, SignalFormat::Bits, doc);
        Signal { size, count, only_if, output, view, ..plain }
    }

    /// An output or wire of fixed width that nobody looks at first.
    pub fn plain(name: String, width: u32, format: SignalFormat, doc: &'static str) -> Self {
        let (size, count, only_if) = (None, None, None);
        let view = View::NONE;
        Signal { name, width, size, element: 0, count, only_if, format, output: false, view, doc }
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
