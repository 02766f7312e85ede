//! Fires the laser at one of a few rates.
//!
//! Mirrors `rtl_ref/vcsel_driver.v`. A counter in `clk_sys` runs through the period while
//! `acquire` is high; with the laser edge at edge s of `clk_sys`:
//!
//! ```text
//! clk_sys      __/^^\__/^^\__/^^\__
//! edge          s-2   s-1    s
//! pre_start    __/^^^^^\___________
//! fire         __/^^^^^\___________
//! pulse_0      _____/^^\___________   clk_laser
//! pulse_1      ________/^^\________
//! laser_pulse  ___________/^^\_____
//! start        ______________/^^^^^
//! laser_on     ______________/^\___   half a cycle of clk_laser, from a DDR output register
//! ```
//!
//! The pulse may be longer, up to eight half cycles: then `laser_pulse` and `laser_on` last.
//!
//! A pulse passes through three registers of `clk_laser` on its way across the device, so that each leg has
//! a cycle. Once `fire` has asked for it, only `rst_laser` stops it, and never moves it: where `acquire` falls or `rst` comes in
//! the two cycles before the laser edge, there is light without a `start`, and no shot is counted.
//!
//! A new `laser_freq` or `laser_en` takes effect when the counter wraps. Without `laser_en` there
//! is no pulse, but shots go on.

use crate::kernel::{AWAKE, Clocked, U, asleep_if};
use crate::{connect, signals};

use super::ddr_output::{self, DdrOutput};

mod params;

pub use params::{LONGEST_PULSE, MOST_RATES, PERIOD_RANGE, PERIODS, Params, Rate};

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset of `clk_sys`.
        pub rst: bool,
        /// Synchronous reset of `clk_laser`.
        pub rst_laser: bool,
        /// Lets the counter run.
        pub acquire: bool,
        /// Lets the laser fire.
        pub laser_en: bool,
        /// Repetition rate.
        #[size(RateBits)]
        pub laser_freq: Rate,
        /// The output is low, whatever the clocks do.
        #[only_if(Hosted)]
        pub laser_off: bool,
        /// Enables of the output register that do not pass.
        #[only_if(Hosted)]
        #[size(Halves)]
        pub laser_block: U<2>,
    }
}

signals! {
    /// Registers in `clk_sys`; the public ones are output ports.
    pub struct Registers {
        /// Two cycles before the laser edge; one cycle.
        pub pre_start: bool,
        /// From the laser edge on; one cycle.
        pub start: bool,
        /// Asks `clk_laser` for a pulse; two cycles before the laser edge.
        pub(crate) fire: bool,
        /// Place in the period.
        #[size(PeriodBits)]
        pub(crate) count: U<16>,
        /// The period in force, less one [cycles of clk_sys].
        #[size(PeriodBits)]
        pub(crate) last: U<16>,
        /// The `laser_en` in force.
        pub(crate) enable: bool,
    }
}

signals! {
    /// Registers in `clk_laser`.
    pub struct LaserRegisters {
        /// `fire` at the edge before.
        fire_last: bool,
        /// `laser_pulse` on its way.
        pulse: [bool; 2],
        /// Enables of the output register, for either half of its cycle; the cycle of `clk_laser` before the
        /// laser edge, and on with a longer pulse.
        #[only_if(Hosted)]
        #[size(Halves)]
        #[view(probe = true)]
        pub laser_pulse: U<2>,
        /// `pulse_1` in the cycles before, as many as a longer pulse goes on for.
        #[size(Stretch)]
        stretch: U<3>,
    }
}

/// The driver: two register banks and the output register.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VcselDriver {
    /// Registers in `clk_sys`.
    pub registers: Registers,
    /// Registers in `clk_laser`.
    pub registers_laser: LaserRegisters,
    /// The DDR output register, port `laser_on`.
    pub ddr_output: DdrOutput,
}

connect! {
    /// Port connections inside the driver.
    pub struct Wires in vcsel_driver (this: &VcselDriver, i: &In) {
        signals registers, registers_laser;
        output laser_on <- this.ddr_output.q;
    }
    ddr_output(clk_laser): ddr_output::In {
        d <- this.registers_laser.laser_pulse;
        off <- i.laser_off;
        block <- i.laser_block;
    }
}

impl Registers {
    /// The rate in force, the place in its period, and whether that is the last; `None` before a
    /// rate has been taken.
    pub fn place(&self, p: &Params) -> Option<(u64, u64, bool)> {
        let rate = p.periods.iter().position(|period| self.last == period - 1)?;
        Some((rate as u64, self.count.get(), self.count == self.last))
    }
}

impl Clocked for Registers {
    type In = In;
    type Params = Params;

    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        let (q, d) = (*self, self);
        let left = q.last - q.count.get();
        d.pre_start = i.acquire && left == 2;
        d.fire = d.pre_start && q.enable;
        d.start = i.acquire && left == 0;
        d.count = q.count + 1;
        if !i.acquire || left == 0 {
            d.count = U::new(0);
            d.last = U::new(p.period(i.laser_freq) - 1);
            d.enable = i.laser_en;
        }
        if i.rst {
            *d = Self::default();
        }
    }

    /// Nobody looks at the count until `pre_start` comes of it.
    #[inline(always)]
    fn quiet(&self, i: &In, p: &Params) -> u64 {
        let q = self;
        if i.rst | q.pre_start | q.fire | q.start {
            AWAKE
        } else if !i.acquire {
            asleep_if(q.next(i, p) == *q)
        } else {
            (q.last.get()).saturating_sub(q.count.get() + 2)
        }
    }

    #[inline(always)]
    fn skip(&mut self, i: &In, _: &Params, edges: u64) {
        if i.acquire {
            self.count = self.count + edges;
        }
    }
}

impl LaserRegisters {
    /// Returns whether a pulse is on its way to the output register.
    #[inline(always)]
    fn has_pulse(&self) -> bool {
        let drives = self.laser_pulse != 0 || self.stretch != 0;
        self.fire_last | (self.pulse != [false; 2]) | drives
    }

    /// Takes the enables for either half of the coming cycle, where a pulse `begins` or goes on.
    #[inline(always)]
    fn drive(&mut self, begins: bool, p: &Params) {
        let begins = u64::from(begins);
        if p.pulse_half_cycles == 1 {
            self.laser_pulse = U::new(begins);
            return;
        }
        let (cycles, before) = (p.stretched(), self.stretch.get());
        let first = begins != 0 || before != 0;
        let ends = (before << 1) >> cycles == 1;
        let second = first && !(p.pulse_half_cycles % 2 == 1 && cycles > 0 && ends);
        self.laser_pulse = U::new(u64::from(first) | u64::from(second) << 1);
        self.stretch = U::new((before << 1 | begins) & ((1 << cycles) - 1));
    }
}

impl Clocked for LaserRegisters {
    type In = LaserIn;
    type Params = Params;

    #[inline(always)]
    fn tick(&mut self, i: &LaserIn, p: &Params) {
        self.drive(self.pulse[1], p);
        self.pulse = [i.fire && !self.fire_last, self.pulse[0]];
        self.fire_last = i.fire;
        if i.rst_laser {
            *self = LaserRegisters { fire_last: i.fire, ..Self::default() };
        }
    }
}

/// Inputs in `clk_laser`: the driver's own `fire` and its reset.
#[derive(Clone, Copy, Debug)]
pub struct LaserIn {
    fire: bool,
    rst_laser: bool,
}

impl VcselDriver {
    /// An edge at which both clocks rise.
    #[inline(always)]
    pub fn rise(&mut self, i: &In, p: &Params) {
        self.rise_laser(i, p);
        self.registers.tick(i, p);
    }

    /// An edge at which only `clk_laser` rises, or the part of `clk_laser` where both do.
    #[inline(always)]
    pub fn rise_laser(&mut self, i: &In, p: &Params) {
        if self.has_pulse() {
            self.ddr_output = self.ddr_output.rise(&Wires::ddr_output(self, i));
            self.registers_laser.tick(&self.laser_inputs(i), p);
        }
    }

    /// What needs no edge: the guard has switched the output off.
    pub fn settle(&mut self, i: &In) {
        self.ddr_output = self.ddr_output.settled(&Wires::ddr_output(self, i));
    }

    /// A falling edge of `clk_laser`.
    #[inline(always)]
    pub fn fall_laser(&mut self) {
        self.ddr_output = self.ddr_output.fall();
    }

    #[inline(always)]
    fn laser_inputs(&self, i: &In) -> LaserIn {
        LaserIn { fire: self.registers.fire, rst_laser: i.rst_laser }
    }

    /// Coming edges of `clk_sys` at which, while the inputs hold, nothing but the count would move,
    /// here and at the edges of `clk_laser` between them.
    #[inline(always)]
    pub fn quiet(&self, i: &In, p: &Params) -> u64 {
        if self.has_pulse() { AWAKE } else { self.registers.quiet(i, p) }
    }

    /// Returns whether a pulse is on its way; what is in `clk_laser` stands still if none is.
    #[inline(always)]
    pub fn has_pulse(&self) -> bool {
        self.registers.fire | self.registers_laser.has_pulse() | self.ddr_output.q
    }

    /// Stands for that many edges of `clk_sys`, all of them quiet.
    #[inline(always)]
    pub fn skip(&mut self, i: &In, p: &Params, edges: u64) {
        self.registers.skip(i, p, edges);
    }

    /// The single-ended laser pulse.
    pub fn laser_on(&self) -> bool {
        self.ddr_output.q
    }
}

#[cfg(test)]
mod tests;
