//! The clocks: on the KC705 125 and 250 MHz from the board's 200 MHz oscillator.
//!
//! Mirrors `rtl_ref/pll.v` (there a PLLE2 with M = 5, D = 1, VCO 1000 MHz, O = 8 and 4). Until it has
//! locked both outputs stay low; their first rising edges come together, one period of `clk_sys` after
//! `locked`, and from then on they rise together with that period. `rst` does not reach it.

use crate::kernel::Time;
use crate::kernel::clock::Clock;
use crate::signals;

/// Oscillator of the KC705 [Hz].
pub const INPUT_HZ: u64 = 200_000_000;
/// The KC705's feedback divider M [1].
pub const MULTIPLY: u64 = 5;
/// The KC705's input divider D [1].
pub const DIVIDE: u64 = 1;
/// The KC705's output divider O of `clk_sys` [1].
pub const OUTPUT_DIVIDE: u64 = 8;

signals! {
    /// There are no input ports beside the clock.
    pub struct In {}
}

signals! {
    /// Output ports beside the clocks.
    pub struct Out {
        /// The outputs run.
        pub locked: bool,
    }
}

/// Parameters that elaboration fixes.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Oscillator [Hz].
    pub input_hz: u64,
    /// Feedback divider, M.
    pub multiply: u64,
    /// Input divider, D.
    pub divide: u64,
    /// Output divider of `clk_sys`, O; `clk_laser` has half of it.
    pub output_divide: u64,
    /// From power-up to `locked`.
    pub lock_time: Time,
}

impl Params {
    /// Frequency of `clk_sys`, rounded down [Hz].
    pub fn system_hz(&self) -> u64 {
        self.input_hz * self.multiply / (self.divide * self.output_divide)
    }

    /// Period of `clk_sys`, rounded to a multiple of 4 fs: the halves of `clk_laser` are whole femtoseconds.
    pub fn cycle(&self) -> Time {
        let quarter = 250_000_000_000_000 * self.divide * self.output_divide;
        let hz = self.input_hz * self.multiply;
        Time::from_fs(4 * ((quarter + hz / 2) / hz))
    }
}

/// The PLL's clocks. Edge times are ideal; jitter is added by who drives the simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Pll {
    /// Input, rising first half a period after power-up.
    pub clk_in: Clock,
    /// Output, whole cycles.
    pub clk_sys: Clock,
    /// Output, half cycles.
    pub clk_laser: Clock,
    /// When the outputs begin to run.
    pub locked_at: Time,
    /// Period of `clk_sys`.
    pub cycle: Time,
}

impl Pll {
    /// The clocks that those dividers make.
    pub fn new(p: &Params) -> Self {
        let (cycle, input) = (p.cycle(), Clock::new(p.input_hz, Time::ZERO));
        let first = p.lock_time + cycle;
        Pll {
            clk_in: Clock::new(p.input_hz, input.fall(0)),
            clk_sys: Clock::of_half(Time::from_fs(cycle.fs() / 2), first),
            clk_laser: Clock::of_half(Time::from_fs(cycle.fs() / 4), first),
            locked_at: p.lock_time,
            cycle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pll(input_hz: u64, multiply: u64, divide: u64, output_divide: u64) -> Pll {
        let lock_time = Time::from_ns(1000);
        Pll::new(&Params { input_hz, multiply, divide, output_divide, lock_time })
    }

    #[test]
    fn both_clocks_rise_together_every_8_ns_from_one_period_after_lock() {
        let pll = pll(INPUT_HZ, MULTIPLY, DIVIDE, OUTPUT_DIVIDE);
        assert_eq!(pll.clk_in.rise(0), Time::from_fs(2_500_000));
        for n in 0..1000 {
            assert_eq!(pll.clk_sys.rise(n), Time::from_ns(1008 + 8 * n));
            assert_eq!(pll.clk_laser.rise(2 * n), pll.clk_sys.rise(n));
            assert_eq!(pll.clk_laser.rise(2 * n + 1), pll.clk_sys.fall(n));
        }
    }

    #[test]
    fn a_period_is_the_nearest_one_whose_quarter_is_whole() {
        for (pll, fs) in [
            (pll(25_000_000, 24, 1, 6), 10_000_000),
            (pll(100_000_000, 9, 1, 8), 8_888_888),
            (pll(100_000_000, 14, 1, 6), 4_285_716),
            (pll(800_000_000, 64, 56, 2), 2_187_500),
            (pll(10_000_000, 128, 3, 128), 300_000_000),
        ] {
            assert_eq!(pll.cycle, Time::from_fs(fs));
            let (begin, end) = (pll.clk_sys.rise(0), pll.clk_sys.rise(1_000_000));
            assert_eq!((end - begin).fs(), 1_000_000 * fs, "every period is the same");
            assert_eq!(pll.clk_laser.fall(0) - pll.clk_laser.rise(0), Time::from_fs(fs / 4));
        }
    }
}
