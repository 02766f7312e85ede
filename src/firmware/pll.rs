//! The clocks: 125 and 250 MHz from the board's 200 MHz oscillator.
//!
//! Mirrors `rtl_ref/pll.v` (PLLE2: M = 5, D = 1, VCO 1000 MHz, O = 8 and 4). Until it has locked
//! both outputs stay low; their first rising edges come together, one period of `clk_sys` after
//! `locked`, and from then on they rise together every 8 ns. `rst` does not reach it.

use crate::kernel::Time;
use crate::kernel::clock::Clock;
use crate::signals;

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

/// What elaboration fixes.
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

/// The PLL's clocks. Edge times are ideal; jitter is added by who drives the simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Pll {
    /// Input, rising first half a period after power-up.
    pub clk_200: Clock,
    /// Output, whole cycles.
    pub clk_sys: Clock,
    /// Output, half cycles.
    pub clk_laser: Clock,
    /// When the outputs begin to run.
    pub locked_at: Time,
}

impl Pll {
    /// The clocks that those dividers make.
    pub fn new(p: &Params) -> Self {
        let input = Clock::new(p.input_hz, 1, 1, Time::ZERO);
        let output = |divide, phase| Clock::new(p.input_hz, p.multiply, p.divide * divide, phase);
        let first = p.lock_time + output(p.output_divide, Time::ZERO).rise(1);
        Pll {
            clk_200: Clock::new(p.input_hz, 1, 1, input.fall(0)),
            clk_sys: output(p.output_divide, first),
            clk_laser: output(p.output_divide / 2, first),
            locked_at: p.lock_time,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_clocks_rise_together_every_8_ns_from_one_period_after_lock() {
        let pll = Pll::new(&Params {
            input_hz: 200_000_000,
            multiply: 5,
            divide: 1,
            output_divide: 8,
            lock_time: Time::from_ns(1000),
        });
        assert_eq!(pll.clk_200.rise(0), Time::from_fs(2_500_000));
        for n in 0..1000 {
            assert_eq!(pll.clk_sys.rise(n), Time::from_ns(1008 + 8 * n));
            assert_eq!(pll.clk_laser.rise(2 * n), pll.clk_sys.rise(n));
            assert_eq!(pll.clk_laser.rise(2 * n + 1), pll.clk_sys.fall(n));
        }
    }
}
