//! Named signals: a struct made by [`signals!`](crate::signals) can list and report its fields.

mod field;
mod signal;
mod unit;

pub use field::{Field, Sink, Source, Word};
pub use signal::{Declaration, Signal, SignalFormat, View};
pub use unit::Unit;

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

/// Declares a struct of signals. One line gives a signal's meaning, name, width and, after `=`,
/// its reset value where that is not zero; `pub` fields are output ports, `pub(crate)` ones are not.
/// Where elaboration decides it, a [`Size`] stands above a field: `#[size(..)]` for its width,
/// `#[count(..)]` for the number of elements of an array, `#[only_if(..)]` for a port that is there unless
/// the size is zero. `#[view(..)]` sets fields of its [`View`]. The documentation may end in the signal's [`Unit`].
#[macro_export]
macro_rules! signals {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[doc = $doc:literal])+
            $(#[only_if($only_if:ident)])? $(#[count($count:ident)])? $(#[size($size:ident)])?
            $(#[view($($view:ident = $shown:literal),+)])?
            $field_vis:vis $field:ident: $ty:ty $(= $reset:expr)?,)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        $vis struct $name { $($(#[doc = $doc])+ $field_vis $field: $ty,)* }

        impl Default for $name {
            fn default() -> Self {
                $name { $($field: $crate::signals!(@reset $($reset)?),)* }
            }
        }

        // All fields are compared, without a branch for each: mostly they are equal.
        impl PartialEq for $name {
            #[inline]
            #[allow(unused_variables, reason = "a module may have no signals of one kind")]
            fn eq(&self, other: &Self) -> bool {
                true $(& $crate::kernel::signals::Field::is_same(&self.$field, &other.$field))*
            }
        }

        impl $crate::kernel::signals::Signals for $name {
            const COUNT: usize = 0 $(+ <$ty as $crate::kernel::signals::Field>::COUNT)*;

            #[allow(clippy::needless_update, reason = "a view may say all there is")]
            fn list() -> Vec<$crate::kernel::signals::Signal> {
                #[allow(unused_mut, reason = "a module may have no signals of one kind")]
                let mut list = Vec::new();
                $(<$ty as $crate::kernel::signals::Field>::declare(
                    $crate::kernel::signals::Signal::declared(&const {
                        $crate::kernel::signals::Declaration {
                            name: stringify!($field),
                            size: $crate::signals!(@size $($size)?),
                            count: $crate::signals!(@size $($count)?),
                            only_if: $crate::signals!(@size $($only_if)?),
                            output: matches!(stringify!($field_vis).as_bytes(), b"pub"),
                            view: $crate::kernel::signals::View {
                                $($($view: $shown,)+)?
                                ..$crate::kernel::signals::View::NONE
                            },
                            unit: $crate::kernel::signals::Unit::of(concat!($($doc),+)),
                            doc: concat!($($doc),+).trim_ascii(),
                        }
                    }),
                    &mut list,
                );)*
                list
            }

            #[inline(always)]
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
