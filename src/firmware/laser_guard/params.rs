//! Parameters of the guard.

/// Parameters that elaboration fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Halves of a cycle of clk_laser that pulses are given for at once, see `ddr_output`.
    pub halves: u32,
    /// Silence of the host after which the laser goes off [cycles of clk_sys].
    pub host_timeout: u32,
    /// Longest pulse, 1 to 8 [half cycles of clk_laser].
    pub longest_pulse: u64,
    /// Shortest time from the begin of a pulse to that of the next [cycles of clk_laser].
    pub shortest_period: u64,
}
