//! Keeps the laser off until it is armed, and switches it off for good when a rule is broken.
//!
//! Mirrors `rtl_ref/laser_guard.v`.
//!
//! ```text
//! host_silent     the host in control has completed no command for a time
//! unlocked        the PLL loses its lock: at once, without a clock
//! interlocked     the interlock is open: likewise
//! pulse_too_long  a pulse would be longer than allowed; its rest is not emitted
//! rate_too_high   a pulse would come sooner after the one before than allowed; it is not emitted
//! ```
//!
//! After that it has to be armed again: by the host through the registers or, with the switch at the control pins, by a
//! rise of `laser_en`. What comes of `laser_block` and `laser_off` is in `ddr_output`, the laser's last register.

use crate::kernel::{Clocked, U};
use crate::{connect, signals};

mod params;
mod pulses;

pub use params::Params;
pub use pulses::{LaserIn, LaserRegisters};

/// Cycles that arming takes: by then it is known whether the PLL or the interlock still prevents it.
const ARMING: u64 = 4;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset of `clk_sys`.
        pub rst: bool,
        /// Synchronous reset of `clk_laser`.
        pub rst_laser: bool,
        /// The PLL has locked, asynchronous.
        pub locked: bool,
        /// The interlock is open, asynchronous.
        pub interlock: bool,
        /// The switch selects the control pins, asynchronous.
        pub select_pins: bool,
        /// `laser_en` of the pins, asynchronous.
        pub laser_en: bool,
        /// A command of the host is complete; one cycle.
        pub heard: bool,
        /// Arms the laser; one cycle.
        pub arm: bool,
        /// Disarms it; one cycle.
        pub disarm: bool,
        /// Enables of the output register, in `clk_laser`.
        #[size(Halves)]
        pub laser_pulse: U<2>,
    }
}

signals! {
    /// Registers in `clk_sys`; the public ones are output ports.
    pub struct GuardRegisters {
        /// The output is low, whatever the clocks do.
        #[only_if(Hosted)]
        pub laser_off: bool,
        /// The laser may fire.
        #[only_if(Hosted)]
        pub armed: bool,
        /// `select_pins` in `clk_sys`.
        pub pins_selected: bool,
        /// `interlock` in `clk_sys`.
        pub interlock_sync: bool,
        /// The laser went off because the host was silent.
        pub host_silent: bool,
        /// Because the PLL was not locked.
        pub unlocked: bool,
        /// Because the interlock was open.
        pub interlocked: bool,
        /// Because a pulse would have been too long.
        pub pulse_too_long: bool,
        /// Because a pulse would have come too soon.
        pub rate_too_high: bool,
        /// First flip-flop of `select_pins`.
        select_pins_meta: bool,
        /// First flip-flop of `laser_en`.
        laser_en_meta: bool,
        /// `laser_en` in `clk_sys`.
        laser_en_sync: bool,
        /// The same at the edge before.
        laser_en_last: bool = true,
        /// First flip-flop of `interlock`.
        interlock_meta: bool,
        /// First flip-flop of `cut_sync`.
        cut_meta: bool,
        /// `unlocked` or `interlocked`.
        cut_sync: bool,
        /// Cycles until the laser is armed.
        arming: U<3>,
        /// Time since the last command [cycles of clk_sys].
        silence: U<32>,
    }
}

/// The guard: two register banks. By default it guards nothing, for firmware without one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LaserGuard {
    /// Registers in `clk_sys`.
    pub registers: GuardRegisters,
    /// Registers in `clk_laser`.
    pub registers_laser: LaserRegisters,
}

connect! {
    /// It has no modules inside.
    pub struct Wires in laser_guard (this: &LaserGuard) {
        signals registers, registers_laser;
    }
}

impl LaserGuard {
    /// At power-up, with both faults that need no clock: arming clears them.
    pub fn new(p: &Params) -> Self {
        let registers = GuardRegisters {
            laser_off: true,
            unlocked: true,
            interlocked: true,
            ..GuardRegisters::default()
        };
        LaserGuard { registers, registers_laser: LaserRegisters::new(p) }
    }

    /// What needs no clock.
    pub fn settle(&mut self, i: &In) {
        let q = &mut self.registers;
        q.unlocked |= !i.locked;
        q.interlocked |= i.interlock;
        q.laser_off |= !i.locked || i.interlock;
    }

    /// An edge at which both clocks rise.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let before = *self;
        self.registers = before.registers.next_with(i, &before.registers_laser, p);
        self.registers_laser = before.registers_laser.next(&before.laser_inputs(i), p);
        self.settle(i);
    }

    /// An edge at which only `clk_laser` rises.
    pub fn rise_laser(&mut self, i: &In, p: &Params) {
        self.registers_laser = self.registers_laser.next(&self.laser_inputs(i), p);
    }

    fn laser_inputs(&self, i: &In) -> LaserIn {
        let armed = self.registers.armed;
        LaserIn { rst_laser: i.rst_laser, armed, laser_pulse: i.laser_pulse }
    }
}

impl GuardRegisters {
    /// After an edge of `clk_sys`.
    fn next_with(&self, i: &In, laser: &LaserRegisters, p: &Params) -> Self {
        let (q, mut d) = (self, *self);
        let (arms, disarms) = if q.pins_selected {
            (q.laser_en_sync && !q.laser_en_last, !q.laser_en_sync)
        } else {
            (i.arm, i.disarm)
        };
        let is_silent = !q.pins_selected && q.armed && q.silence.get() >= u64::from(p.host_timeout);
        let (too_long, too_soon) = laser.violations();
        let trips = q.cut_sync || is_silent || too_long || too_soon;
        d.laser_off = !q.armed || trips || q.unlocked || q.interlocked;
        (d.select_pins_meta, d.pins_selected) = (i.select_pins, q.select_pins_meta);
        (d.laser_en_meta, d.laser_en_sync) = (i.laser_en, q.laser_en_meta);
        d.laser_en_last = q.laser_en_sync;
        (d.interlock_meta, d.interlock_sync) = (i.interlock, q.interlock_meta);
        (d.cut_meta, d.cut_sync) = (q.unlocked || q.interlocked, q.cut_meta);
        d.silence = match () {
            () if i.heard || arms => U::new(0),
            () if q.silence == u64::from(u32::MAX) => q.silence,
            () => q.silence + 1,
        };
        if arms {
            (d.unlocked, d.interlocked) = (false, false);
            (d.host_silent, d.pulse_too_long, d.rate_too_high) = (false, false, false);
        }
        if q.armed {
            d.host_silent |= is_silent;
            d.pulse_too_long |= too_long;
            d.rate_too_high |= too_soon;
        }
        if q.arming != 0 {
            d.arming = q.arming - 1;
        }
        if q.arming == 1 {
            d.armed = !q.cut_sync;
        }
        if arms {
            (d.armed, d.arming) = (false, U::new(ARMING));
        }
        d.armed &= !(q.armed && trips);
        if disarms || i.rst {
            (d.armed, d.arming) = (false, U::new(0));
        }
        // A `laser_en` that is high already does not arm.
        d.laser_en_last |= i.rst;
        d
    }
}

#[cfg(test)]
mod tests;
