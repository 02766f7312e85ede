//! Length and spacing of pulses, in `clk_laser`.

use crate::kernel::{Clocked, U};
use crate::signals;

use super::params::Params;

signals! {
    /// Registers in `clk_laser`; the public one is an output port.
    pub struct LaserRegisters {
        /// Enables that do not pass.
        #[only_if(Hosted)]
        #[size(Halves)]
        pub laser_block: U<2>,
        /// `armed` at the edge before.
        armed_last: bool,
        /// Pulses are checked: `laser_block` has had time to open.
        checks: bool,
        /// How long the output has been high without a break [half cycles].
        run: U<4>,
        /// Time until a pulse may begin [cycles of clk_laser].
        gap: U<16>,
        /// It is above 1.
        gap_lasts: bool,
        /// A pulse would have been too long.
        too_long: bool,
        /// It would have come too soon.
        too_soon: bool,
    }
}

/// Inputs in `clk_laser`.
#[derive(Clone, Copy, Debug)]
pub struct LaserIn {
    /// Synchronous reset of `clk_laser`.
    pub rst_laser: bool,
    /// The laser may fire.
    pub armed: bool,
    /// Enables of the output register.
    pub laser_pulse: U<2>,
}

impl LaserRegisters {
    /// At power-up.
    pub fn new(p: &Params) -> Self {
        LaserRegisters { laser_block: U::new((1 << p.halves) - 1), ..Self::default() }
    }

    /// Returns whether a pulse would have been too long, and whether it would have come too soon.
    pub fn violations(&self) -> (bool, bool) {
        (self.too_long, self.too_soon)
    }
}

impl Clocked for LaserRegisters {
    type In = LaserIn;
    type Params = Params;

    fn next(&self, i: &LaserIn, p: &Params) -> Self {
        let (q, mut d) = (self, *self);
        let bit = |word: U<2>, bit: u32| word.get() >> bit & 1 == 1;
        let last = p.halves - 1;
        let first = bit(i.laser_pulse, 0);
        let second = p.halves > 1 && bit(i.laser_pulse, last);
        let (first_blocked, second_blocked) = (bit(q.laser_block, 0), bit(q.laser_block, last));
        let first_passes = first && !first_blocked;
        let second_passes = first_passes && second && !second_blocked;
        let begins = first_passes && q.run == 0;

        (d.armed_last, d.checks) = (i.armed, q.armed_last && i.armed);
        d.run = if second_passes { q.run + 2 } else { U::new(0) };
        d.gap = match q.gap.get() {
            _ if begins => U::new(p.shortest_period - 1),
            0 => U::new(0),
            _ => q.gap - 1,
        };
        d.gap_lasts = d.gap.get() > 1;
        let too_soon = d.run == 0 && d.gap != 0;
        let blocks_first = !i.armed || !q.armed_last || d.run.get() >= p.longest_pulse || too_soon;
        let blocks_second = blocks_first || (d.run.get() + 1) % 16 >= p.longest_pulse;
        let blocks = u64::from(blocks_first) | u64::from(blocks_second) << 1;
        d.laser_block = U::new(blocks & ((1 << p.halves) - 1));
        if !q.checks {
            (d.too_long, d.too_soon) = (false, false);
        } else if q.too_long || q.too_soon {
            // The first of them is the reason.
        } else if first && first_blocked {
            (d.too_long, d.too_soon) = (q.run != 0, q.run == 0);
        } else if second && !second_passes {
            (d.too_long, d.too_soon) = (first, !first);
        }
        if i.rst_laser {
            (d.armed_last, d.checks) = (false, false);
            (d.too_long, d.too_soon) = (false, false);
            d.laser_block = U::new((1 << p.halves) - 1);
        }
        d
    }
}
