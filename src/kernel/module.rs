//! Modules inside modules: one way through all of them, for whoever lists, compares or copies their
//! signals.

use super::signals::{Signal, Signals};

/// A module, as far as others may look into it.
pub trait Module {
    /// Signals that it and the modules inside it hold.
    const COUNT: usize;
    /// Takes a visitor through its own signals, then through the modules inside, in the order in which
    /// they are declared. `then` is the same module at another time, for a visitor that compares.
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor);
}

/// Visitor of a hierarchy.
pub trait Visitor {
    /// Signals of the module that was entered last; `field` is their path in the module's struct.
    fn signals<S: Signals>(&mut self, field: &'static str, now: &S, then: Option<&mut S>);
    /// Names in the module that was entered last for values that are held elsewhere.
    fn aliases(&mut self, _: &'static [Alias]) {}
    /// A module inside: visits it, or leaves it out.
    fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, then: Option<&mut M>);
}

/// A module inside another.
#[derive(Debug)]
pub struct Instance {
    /// Its name, which is also that of the field.
    pub name: &'static str,
    /// Name of the module, which is also that of its file in `rtl_ref`.
    pub module: &'static str,
    /// Line of the module's declaration.
    pub declared: u32,
    /// Line of this instance, in the file of the module around it.
    pub instantiated: u32,
    /// Clock ports, and the clock that each has.
    pub clocks: &'static [(&'static str, &'static str)],
    /// Its input ports beside the clocks.
    pub inputs: fn() -> Vec<Signal>,
    /// Source of each input: a dotted path inside the parent.
    pub sources: &'static [(&'static str, &'static str)],
    /// Output ports that are no registers of it, and the wires that they drive.
    pub outputs: &'static [(&'static str, &'static str)],
}

/// A name for a value that is held elsewhere.
#[derive(Debug)]
pub struct Alias {
    pub name: &'static str,
    /// True if it is an output port; if not, a wire.
    pub output: bool,
    /// Dotted path of the value inside the module.
    pub source: &'static str,
}

impl<S: Signals> Module for S {
    const COUNT: usize = S::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("", self, then);
    }
}

/// Makes a module of a struct whose signals are those of its field `registers`: what else it has are memories.
#[macro_export]
macro_rules! module_of_registers {
    ($Block:ident) => {
        impl $crate::kernel::module::Module for $Block {
            const COUNT: usize = $crate::kernel::module::count(|block: &Self| &block.registers);

            #[inline(always)]
            fn visit(
                &self,
                then: Option<&mut Self>,
                visitor: &mut impl $crate::kernel::module::Visitor,
            ) {
                let registers = then.map(|then| &mut then.registers);
                visitor.signals("registers", &self.registers, registers);
            }
        }
    };
}

/// Signals in the module that a field of `M` is.
#[doc(hidden)]
pub const fn count<M, F: Module>(_: fn(&M) -> &F) -> usize {
    F::COUNT
}
