//! What every clocked module is.

/// A bank of registers and the logic between them.
///
/// The value is Q; [`Clocked::next`] reads it and returns D. Nothing else changes a register,
/// so the order in which modules are stepped decides nothing.
pub trait Clocked: Copy + PartialEq + std::fmt::Debug {
    /// Input ports, as they stand before the edge.
    type In;

    /// What elaboration fixes: Verilog parameters and ROM contents. `()` for most modules.
    type Params: ?Sized;

    /// The registers after the next rising edge.
    fn next(&self, i: &Self::In, p: &Self::Params) -> Self;
}
