//! Port connections, stated once: for the simulation and for the waveform.

/// Where an input port comes from: `(module, port, source)`, each a dotted path inside the parent.
pub type Connection = (&'static str, &'static str, &'static str);

/// Joins the input ports of a container's modules to their sources.
///
/// From one list it makes a method that builds every module's `In` and a table of the same
/// connections, by which waveforms declare an input port as an alias of the signal that drives
/// it. A source is a path that begins with the container (`this`) or its own input ports.
#[macro_export]
macro_rules! connect {
    (
        $(#[$doc:meta])*
        $vis:vis fn of($this:ident: &$Top:ty $(, $input:ident: &$In:ty)?) -> $Wires:ident;
        $($module:ident: $file:ident::In {
            $($port:ident <- $root:ident $(. $field:ident)+;)*
        })*
    ) => {
        /// The input ports of every module, as they stand between two edges.
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $Wires {
            $(
                #[doc = concat!("Input ports of `", stringify!($module), "`.")]
                $vis $module: $file::In,
            )*
        }

        impl $Wires {
            /// Every connection that `of` makes.
            $vis const CONNECTIONS: &[$crate::kernel::connect::Connection] = &[
                $($((
                    stringify!($module),
                    stringify!($port),
                    concat!(stringify!($root) $(, ".", stringify!($field))+),
                ),)*)*
            ];

            /// The modules and their input ports.
            $vis fn inputs() -> Vec<(&'static str, Vec<$crate::kernel::signals::Signal>)> {
                vec![$((
                    stringify!($module),
                    <$file::In as $crate::kernel::signals::Signals>::list(),
                ),)*]
            }

            $(#[$doc])*
            #[inline(always)]
            $vis fn of($this: &$Top $(, $input: &$In)?) -> $Wires {
                $Wires {
                    $($module: $file::In { $($port: $root $(. $field)+,)* },)*
                }
            }
        }
    };
}
