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

/// Laser period for each `laser_freq` of the KC705 (Table 6.1) [cycles of clk_sys].
pub const PERIODS: [u64; 4] = [25, 13, 8, 6];
/// Most rates to choose from.
pub const MOST_RATES: usize = 8;
/// Longest pulse [half cycles of clk_laser].
pub const LONGEST_PULSE: u32 = 8;
/// Shortest and longest period: `pre_start` comes two cycles before the laser edge, and the edge before is
/// that of a shot [cycles of clk_sys].
pub const PERIOD_RANGE: std::ops::RangeInclusive<u64> = 4..=65_535;

/// Code of the period in force, with room for all.
pub type Rate = U<3>;

/// Verilog parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Params {
    /// Laser period for each `laser_freq`, one to eight of them; a `laser_freq` past the last has the last
    /// [cycles of clk_sys].
    pub periods: Vec<u64>,
    /// Length of the pulse, one to eight [half cycles of clk_laser].
    pub pulse_half_cycles: u32,
}

impl Default for Params {
    /// The KC705's.
    fn default() -> Self {
        Params { periods: PERIODS.to_vec(), pulse_half_cycles: 1 }
    }
}

impl Params {
    /// The period that a `laser_freq` stands for [cycles of clk_sys].
    #[inline(always)]
    pub fn period(&self, laser_freq: Rate) -> u64 {
        self.periods[laser_freq.index().min(self.periods.len() - 1)]
    }

    /// The period for each value that `laser_freq` can have [cycles of clk_sys].
    pub fn every_period(&self) -> [u64; MOST_RATES] {
        std::array::from_fn(|code| self.period(Rate::new(code as u64)))
    }

    /// The longest period [cycles of clk_sys].
    pub fn longest_period(&self) -> u64 {
        self.periods.iter().copied().max().unwrap_or_default()
    }

    /// Cycles of clk_laser after the first in which the pulse is high at its begin.
    fn stretched(&self) -> u32 {
        self.pulse_half_cycles.div_ceil(2) - 1
    }
}

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
        #[size(Halves)]
        #[view(probe = true)]
        laser_pulse: U<2>,
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
    pub struct Wires(this: &VcselDriver) {
        signals registers, registers_laser;
        output laser_on <- this.ddr_output.q;
    }
    ddr_output(clk_laser): ddr_output::In {
        d <- this.registers_laser.laser_pulse;
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
    fn next(&self, i: &In, p: &Params) -> Self {
        let (q, mut d) = (self, *self);
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
        if i.rst { Self::default() } else { d }
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
        self.fire_last | self.pulse[0] | self.pulse[1] | drives
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
        let registers = self.registers.next(i, p);
        self.rise_laser(i, p);
        self.registers = registers;
    }

    /// An edge at which only `clk_laser` rises, or the part of `clk_laser` where both do.
    #[inline(always)]
    pub fn rise_laser(&mut self, i: &In, p: &Params) {
        let laser = self.laser_inputs(i);
        self.ddr_output = self.ddr_output.rise(&Wires::ddr_output(self));
        self.registers_laser.tick(&laser, p);
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
mod tests {
    use super::*;

    /// Runs for `cycles` of clk_sys and returns, for each, `pre_start`, `start`, the pulse in the
    /// first and in the second half, and `laser_on` in the first quarter and anywhere later.
    fn run(driver: &mut VcselDriver, i: &In, cycles: usize) -> Vec<[bool; 6]> {
        let mut seen = Vec::new();
        for _ in 0..cycles {
            driver.rise(i, &Params::default());
            let pulse_first = driver.registers_laser.laser_pulse != 0;
            let on_first = driver.laser_on();
            driver.fall_laser();
            let mut on_later = driver.laser_on();
            driver.rise_laser(i, &Params::default());
            let pulse_second = driver.registers_laser.laser_pulse != 0;
            on_later |= driver.laser_on();
            driver.fall_laser();
            on_later |= driver.laser_on();
            let registers = driver.registers;
            seen.push([
                registers.pre_start,
                registers.start,
                pulse_first,
                pulse_second,
                on_first,
                on_later,
            ]);
        }
        seen
    }

    fn input(laser_freq: u64) -> In {
        let laser_freq = U::new(laser_freq);
        In { rst: false, rst_laser: false, acquire: true, laser_en: true, laser_freq }
    }

    fn ready(i: &In) -> VcselDriver {
        let mut driver = VcselDriver::default();
        run(&mut driver, &In { acquire: false, ..*i }, 1);
        driver
    }

    #[test]
    fn the_first_laser_edge_comes_a_period_after_acquire_and_then_every_period() {
        for (code, period) in PERIODS.into_iter().enumerate() {
            let i = input(code as u64);
            let seen = run(&mut ready(&i), &i, 3 * period as usize);
            let at =
                |k: usize| (1..=3).map(|shot| shot * period as usize - 1 - k).collect::<Vec<_>>();
            let cycles = |signal: usize| -> Vec<usize> {
                (0..seen.len()).filter(|&cycle| seen[cycle][signal]).collect()
            };
            assert_eq!(cycles(0), at(2), "pre_start");
            assert_eq!(cycles(1), at(0), "start");
            assert!(cycles(2).is_empty(), "laser_pulse in a first half");
            assert_eq!(cycles(3), at(1), "laser_pulse in the half before the laser edge");
            assert_eq!(cycles(4), at(0), "laser_on in the 2 ns after the laser edge");
            assert!(cycles(5).is_empty(), "laser_on later");
        }
    }

    #[test]
    fn a_new_rate_waits_for_the_wrap() {
        let mut driver = ready(&input(3));
        run(&mut driver, &input(3), 3);
        let seen = run(&mut driver, &input(1), 3 + 13);
        let starts: Vec<_> = (0..seen.len()).filter(|&cycle| seen[cycle][1]).collect();
        assert_eq!(starts, [2, 15]);
    }

    #[test]
    fn without_laser_en_shots_go_on_in_the_dark() {
        let i = In { laser_en: false, ..input(3) };
        let seen = run(&mut ready(&i), &i, 12);
        assert_eq!(seen.iter().filter(|cycle| cycle[1]).count(), 2);
        assert!(seen.iter().all(|cycle| !cycle[2..].contains(&true)));
    }

    #[test]
    fn a_pulse_lasts_as_many_half_cycles_as_are_asked_for() {
        for pulse_half_cycles in 1..=LONGEST_PULSE {
            let (i, p) = (input(0), Params { pulse_half_cycles, ..Params::default() });
            let mut driver = ready(&i);
            let mut halves = Vec::new();
            for _ in 0..60 {
                driver.rise(&i, &p);
                for again in [false, true] {
                    if again {
                        driver.rise_laser(&i, &p);
                    }
                    halves.push(driver.laser_on());
                    driver.fall_laser();
                    halves.push(driver.laser_on());
                }
            }
            let on: Vec<_> = (0..halves.len()).filter(|&half| halves[half]).collect();
            let of_shot = |edge: usize| 4 * edge..4 * edge + pulse_half_cycles as usize;
            assert_eq!(on, of_shot(24).chain(of_shot(49)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_rate_past_the_last_is_the_last() {
        let p = Params { periods: vec![9, 5, 7], ..Params::default() };
        assert_eq!([0, 1, 2, 3, 7].map(|rate| p.period(U::new(rate))), [9, 5, 7, 7, 7]);
    }
}
