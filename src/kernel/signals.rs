//! Named signals: a struct made by [`signals!`](crate::signals) can list and report its fields.

use super::bits::{S, U};
use super::sizes::{Size, Sizes};
use super::thermometer::{PartialOnes, Thermometer};

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

/// Takes signal values; `id` is the signal's place in the list of its module plus an offset.
pub trait Sink {
    /// A word of up to 64 bits.
    fn word(&mut self, id: usize, value: u64);
    /// The taps of a delay line, or with a `group` above 1 the ones among so many taps each (see
    /// [`partial_ones`](super::partial_ones)).
    fn taps(&mut self, id: usize, value: &Thermometer, group: usize);
}

/// Gives signal values; `id` is as in [`Sink`].
pub trait Source {
    /// A word, its sign extended to 64 bits if it has one.
    fn word(&mut self, id: usize) -> u64;
    /// The taps of a delay line.
    fn taps(&mut self, id: usize) -> Thermometer;
}

/// A value that stands for one or more signals.
pub trait Field: Copy + PartialEq {
    /// Number of signals.
    const COUNT: usize;
    /// Appends the signals, shaped after `like` (its name, doc and direction).
    fn declare(like: Signal, list: &mut Vec<Signal>);
    /// Reports what differs from `before`, or everything.
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink);
    /// The value with what the source gives.
    fn given(id: usize, source: &mut impl Source) -> Self;
}

/// A struct of signals: the ports or the registers of one module.
pub trait Signals: Copy + PartialEq {
    /// Number of signals.
    const COUNT: usize;
    /// The signals in order of declaration.
    fn list() -> Vec<Signal>;
    /// Reports what differs from `before`, or everything.
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink);
    /// All signals as the source gives them.
    fn given(id: usize, source: &mut impl Source) -> Self;
}

/// A field that is a single word.
pub trait Word: Copy + PartialEq {
    /// Its width [bits].
    const WIDTH: u32;
    /// Display format.
    const FORMAT: SignalFormat;
    fn bits(&self) -> u64;
    /// The word of those bits; a number has its sign extended.
    fn of_bits(bits: u64) -> Self;
}

impl Word for bool {
    const WIDTH: u32 = 1;
    const FORMAT: SignalFormat = SignalFormat::Bits;
    fn bits(&self) -> u64 {
        *self as u64
    }
    fn of_bits(bits: u64) -> Self {
        bits & 1 == 1
    }
}

impl<const N: u32> Word for U<N> {
    const WIDTH: u32 = N;
    const FORMAT: SignalFormat = SignalFormat::Unsigned;
    fn bits(&self) -> u64 {
        self.get()
    }
    fn of_bits(bits: u64) -> Self {
        U::new(bits)
    }
}

impl<const N: u32, const F: u32> Word for S<N, F> {
    const WIDTH: u32 = N;
    const FORMAT: SignalFormat = SignalFormat::Signed { fraction: F };
    fn bits(&self) -> u64 {
        S::bits(*self)
    }
    fn of_bits(bits: u64) -> Self {
        S::new(bits as i64)
    }
}

impl<T: Word> Field for T {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(Signal { width: T::WIDTH, format: T::FORMAT, ..like });
    }
    #[inline(always)]
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before != Some(self) {
            sink.word(id, self.bits());
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        T::of_bits(source.word(id))
    }
}

impl<T: Word, const K: usize> Field for [T; K] {
    const COUNT: usize = K;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        for k in 0..K {
            let name = format!("{}_{k}", like.name);
            T::declare(Signal { name, element: k as u32, ..like.clone() }, list);
        }
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        for k in 0..K {
            self[k].changes(before.map(|b| &b[k]), id + k, sink);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        std::array::from_fn(|k| T::given(id + k, source))
    }
}

impl Field for Thermometer {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(Signal { format: SignalFormat::Taps, ..like });
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before != Some(self) {
            sink.taps(id, self, 1);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        source.taps(id)
    }
}

impl<const GROUP: usize> Field for PartialOnes<GROUP> {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(like);
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before != Some(self) {
            sink.taps(id, &self.0, GROUP);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        PartialOnes(source.taps(id))
    }
}

/// Declares a struct of signals. One line gives a signal's meaning, name, width and, after `=`,
/// its reset value where that is not zero; `pub` fields are output ports, `pub(crate)` ones are not.
/// Where elaboration decides it, a [`Size`] stands above a field: `#[size(..)]` for its width,
/// `#[count(..)]` for the number of elements of an array, `#[only_if(..)]` for a port that is there unless
/// the size is zero. `#[view(..)]` sets fields of its [`View`].
#[macro_export]
macro_rules! signals {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[doc = $doc:literal])+
            $(#[only_if($only_if:ident)])? $(#[count($count:ident)])? $(#[size($size:ident)])?
            $(#[view($($view:ident = $shown:literal),+)])?
            $field_vis:vis $field:ident: $ty:ty $(= $reset:expr)?,)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $name { $($(#[doc = $doc])+ $field_vis $field: $ty,)* }

        impl Default for $name {
            fn default() -> Self {
                $name { $($field: $crate::signals!(@reset $($reset)?),)* }
            }
        }

        impl $crate::kernel::signals::Signals for $name {
            const COUNT: usize = 0 $(+ <$ty as $crate::kernel::signals::Field>::COUNT)*;

            #[allow(clippy::needless_update, reason = "a view may say all there is")]
            fn list() -> Vec<$crate::kernel::signals::Signal> {
                #[allow(unused_mut, reason = "a module may have no signals of one kind")]
                let mut list = Vec::new();
                $(<$ty as $crate::kernel::signals::Field>::declare(
                    $crate::kernel::signals::Signal {
                        name: stringify!($field).to_owned(),
                        width: 0,
                        size: $crate::signals!(@size $($size)?),
                        element: 0,
                        count: $crate::signals!(@size $($count)?),
                        only_if: $crate::signals!(@size $($only_if)?),
                        format: $crate::kernel::signals::SignalFormat::Bits,
                        output: matches!(stringify!($field_vis), "pub"),
                        view: $crate::kernel::signals::View {
                            $($($view: $shown,)+)?
                            ..$crate::kernel::signals::View::NONE
                        },
                        doc: concat!($($doc),+).trim_ascii(),
                    },
                    &mut list,
                );)*
                list
            }

            #[inline]
            #[allow(unused_variables, reason = "a module may have no signals of one kind")]
            fn changes(
                &self,
                before: Option<&Self>,
                id: usize,
                sink: &mut impl $crate::kernel::signals::Sink,
            ) {
                let _next = id;
                $(
                    $crate::kernel::signals::Field::changes(
                        &self.$field, before.map(|b| &b.$field), _next, sink);
                    let _next = _next + <$ty as $crate::kernel::signals::Field>::COUNT;
                )*
            }

            #[allow(unused_variables, reason = "a module may have no signals of one kind")]
            fn given(id: usize, source: &mut impl $crate::kernel::signals::Source) -> Self {
                let _next = id;
                $(
                    let $field = <$ty as $crate::kernel::signals::Field>::given(_next, source);
                    let _next = _next + <$ty as $crate::kernel::signals::Field>::COUNT;
                )*
                $name { $($field,)* }
            }
        }
    };
    (@size) => { None };
    (@size $size:ident) => { Some($crate::kernel::sizes::Size::$size) };
    (@reset) => { Default::default() };
    (@reset $reset:expr) => { $reset };
}

/// Declares the states of a machine: a fieldless enum with its width, the first state the reset
/// value, codes counted from 0.
#[macro_export]
macro_rules! states {
    ($(#[$meta:meta])* $vis:vis enum $name:ident: $width:literal {
        $($(#[$state_meta:meta])* $state:ident,)+
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        $vis enum $name { #[default] $($(#[$state_meta])* $state,)+ }

        impl $crate::kernel::signals::Word for $name {
            const WIDTH: u32 = $width;
            const FORMAT: $crate::kernel::signals::SignalFormat =
                $crate::kernel::signals::SignalFormat::State(&[$(stringify!($state)),+]);
            fn bits(&self) -> u64 {
                *self as u64
            }
            fn of_bits(bits: u64) -> Self {
                let states = [$($name::$state),+];
                states.get(bits as usize).copied().unwrap_or_default()
            }
        }
    };
}
