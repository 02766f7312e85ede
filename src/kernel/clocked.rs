//! Trait of every clocked module.

/// A bank of registers and the logic between them.
///
/// The value is Q; [`Clocked::next`] reads it and returns D. Nothing else changes a register,
/// so the order in which modules are stepped decides nothing.
pub trait Clocked: Copy + PartialEq + std::fmt::Debug {
    /// Input ports, as they stand before the edge.
    type In;

    /// Parameters that elaboration fixes: Verilog parameters and ROM contents. `()` for most modules.
    type Params: ?Sized;

    /// The registers after the next rising edge. A module has this or [`Clocked::tick`].
    #[inline(always)]
    fn next(&self, i: &Self::In, p: &Self::Params) -> Self {
        let mut d = *self;
        d.tick(i, p);
        d
    }

    /// The rising edge. A module whose registers are too wide to copy at every edge has this in place.
    #[inline(always)]
    fn tick(&mut self, i: &Self::In, p: &Self::Params) {
        *self = self.next(i, p);
    }

    /// Coming edges at which, while the inputs hold, nothing would move but counters whose values
    /// no other module acts on.
    fn quiet(&self, _i: &Self::In, _p: &Self::Params) -> u64 {
        AWAKE
    }

    /// Stands for that many edges, all of them quiet.
    fn skip(&mut self, _i: &Self::In, _p: &Self::Params, _edges: u64) {}
}

/// The coming edge may change an output.
pub const AWAKE: u64 = 0;

/// No edge changes anything until an input does.
pub const ASLEEP: u64 = u64::MAX;

/// [`ASLEEP`] if so, or else [`AWAKE`].
#[inline(always)]
pub const fn asleep_if(idle: bool) -> u64 {
    if idle { ASLEEP } else { AWAKE }
}
