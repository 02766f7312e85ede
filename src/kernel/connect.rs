//! Port connections, stated once: for the simulation and for the waveform.

/// Joins the modules inside a container: their clocks, their input ports to their sources, and what of
/// theirs the container shows under names of its own.
///
/// From one list it makes, on an empty struct, a function for each module that reads its input
/// ports, and the container's [`Module`](crate::kernel::module::Module), by which waveforms have all of
/// it. After `in` stands the container's module. In the braces after the struct stand the fields with
/// signals of the container's own, then its wires and output ports that show what a module inside holds.
/// Each module is a field of the container
/// and has, in parentheses, its clock ports, with `port <- clock` where that is called otherwise. A
/// source is a path that begins with the container (`this`) or with the container's own input ports. Names
/// in brackets have the signals of the same names in one source. After `->` stand output ports of a module that are no
/// registers of it. `#[watches]` marks a module that nothing reads: runs that nobody traces need not move it.
#[macro_export]
macro_rules! connect {
    (
        $(#[$doc:meta])*
        $vis:vis struct $Wires:ident in $container:ident $from:tt {
            $(signals $($own:ident),+;)?
            $(wire $($wire:ident <- this $(. $wire_from:ident)+)?
                $([$($wires:ident),+] <- $wires_from:expr)?;)*
            $(output $($output:ident <- this $(. $output_from:ident)+)?
                $([$($outputs:ident),+] <- $outputs_from:expr)?;)*
        }
        $($(#[$mark:ident])? $module:ident ($($clock:ident $(<- $clock_from:ident)?),*): $file:ident::In {
            $($($port:ident <- $root:ident $(. $field:ident)+)?
                $([$($ports:ident),+ $(,)?] <- $ports_from:expr)?;)*
        } $(-> { $($driver:ident: this $(. $driven:ident)+,)+ })?)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        $vis struct $Wires;

        impl $Wires {
            /// The modules that only watch.
            $vis const WATCHERS: &[&str] =
                &[$($($crate::connect!(@watcher $mark $module),)?)*];

            $(
                #[doc = concat!("Input ports of `", stringify!($module), "` as they stand.")]
                #[inline(always)]
                #[allow(unused_variables, reason = "a module may be fed from one side only")]
                $vis fn $module $from -> $file::In {
                    $file::In {
                        $($($port: $root $(. $field)+,)? $($($ports: $ports_from.$ports,)+)?)*
                    }
                }
            )*
        }

        impl $crate::kernel::module::Module for $crate::connect!(@container $from) {
            const COUNT: usize = 0
                $($(+ $crate::kernel::module::count(|this: &Self| &this.$own))+)?
                $(+ $crate::kernel::module::count(|this: &Self| &this.$module))*;

            #[inline(always)]
            fn visit(
                &self,
                mut then: Option<&mut Self>,
                visitor: &mut impl $crate::kernel::module::Visitor,
            ) {
                $($(visitor.signals(
                    stringify!($own),
                    &self.$own,
                    then.as_deref_mut().map(|then| &mut then.$own),
                );)+)?
                visitor.aliases(const { &[
                    $(
                        $($crate::connect!(@alias $wire, false, "this" $(, ".", stringify!($wire_from))+),)?
                        $($($crate::connect!(@alias $wires, false, stringify!($wires_from), ".", stringify!($wires)),)+)?
                    )*
                    $(
                        $($crate::connect!(@alias $output, true, "this" $(, ".", stringify!($output_from))+),)?
                        $($($crate::connect!(@alias $outputs, true, stringify!($outputs_from), ".", stringify!($outputs)),)+)?
                    )*
                ] });
                $(visitor.module(
                    const { &$crate::kernel::module::Instance {
                        name: stringify!($module),
                        module: stringify!($file),
                        declared: $crate::kernel::verilog::line_of(
                            $crate::verilog!($file),
                            &[concat!("\nmodule ", stringify!($file), " ")],
                        ),
                        instantiated: $crate::kernel::verilog::line_of(
                            $crate::verilog!($container),
                            &[
                                concat!("\n    ) ", stringify!($module), " ("),
                                concat!("\n    ", stringify!($file), " ", stringify!($module), " ("),
                            ],
                        ),
                        clocks: &[$($crate::connect!(@clock $clock $($clock_from)?)),*],
                        inputs: <$file::In as $crate::kernel::signals::Signals>::list,
                        sources: &[$(
                            $((
                                stringify!($port),
                                concat!(stringify!($root) $(, ".", stringify!($field))+),
                            ),)?
                            $($((
                                stringify!($ports),
                                concat!(stringify!($ports_from), ".", stringify!($ports)),
                            ),)+)?
                        )*],
                        outputs: &[$($((
                            stringify!($driver),
                            concat!("this" $(, ".", stringify!($driven))+),
                        ),)+)?],
                    } },
                    &self.$module,
                    then.as_deref_mut().map(|then| &mut then.$module),
                );)*
            }
        }
    };
    (@alias $name:ident, $output:literal, $($source:tt)+) => {
        $crate::kernel::module::Alias {
            name: stringify!($name),
            output: $output,
            source: concat!($($source)+),
        }
    };
    (@container ($this:ident: &$Container:ident $($rest:tt)*)) => { $Container };
    (@watcher watches $module:ident) => { stringify!($module) };
    (@clock $clock:ident) => { (stringify!($clock), stringify!($clock)) };
    (@clock $clock:ident $from:ident) => { (stringify!($clock), stringify!($from)) };
}
