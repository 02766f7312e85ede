//! Port connections, stated once: for the simulation and for the waveform.

/// Where an input port comes from: `(module, port, source)`, each a dotted path inside the parent.
pub type Connection = (&'static str, &'static str, &'static str);

/// Joins the input ports of a container's modules to their sources.
///
/// From one list it makes, on an empty struct, a function for each module that reads its input
/// ports, and a table of the same connections, by which waveforms declare an input port as an alias
/// of the signal that drives it. A source is a path that begins with the container (`this`) or with
/// the container's own input ports.
#[macro_export]
macro_rules! connect {
    (
        $(#[$doc:meta])*
        $vis:vis struct $Wires:ident $from:tt;
        $($module:ident: $file:ident::In {
            $($port:ident <- $root:ident $(. $field:ident)+;)*
        })*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        $vis struct $Wires;

        impl $Wires {
            /// Every connection.
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

            $(
                #[doc = concat!("Input ports of `", stringify!($module), "` as they stand.")]
                #[inline(always)]
                #[allow(unused_variables, reason = "a module may be fed from one side only")]
                $vis fn $module $from -> $file::In {
                    $file::In { $($port: $root $(. $field)+,)* }
                }
            )*
        }
    };
}
