//! Brings the acquisition computer's signals into `clk_sys`.
//!
//! Mirrors `rtl_ref/control_sync.v`. Two flip-flops each, without reset. The bits of
//! `laser_freq` cross side by side; a mixed value that an unlucky edge might catch lasts one
//! cycle and matters only if the laser's counter wraps in it. With a host, they are taken once two
//! samples of all of them agree, two cycles later.

use crate::kernel::{Clocked, asleep_if};
use crate::signals;

use super::vcsel_driver::Rate;

signals! {
    /// Input ports, asynchronous.
    pub struct In {
        /// SPAD quench mode (Table 6.2).
        pub mode: bool,
        /// Laser repetition rate (Table 6.1).
        #[size(RateBits)]
        pub laser_freq: Rate,
        /// Lets the laser fire.
        pub laser_en: bool,
        /// Lets the estimator start.
        pub dsp_en: bool,
        /// Abandons the frame.
        pub dsp_rst: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct ControlSync {
        /// `mode` in `clk_sys`.
        pub mode_sync: bool,
        /// `laser_freq` in `clk_sys`.
        #[size(RateBits)]
        pub laser_freq_sync: Rate,
        /// `laser_en` in `clk_sys`.
        pub laser_en_sync: bool,
        /// `dsp_en` in `clk_sys`.
        pub dsp_en_sync: bool,
        /// `dsp_rst` in `clk_sys`.
        pub dsp_rst_sync: bool,
        /// First flip-flop of `mode`.
        mode_meta: bool,
        /// First flip-flops of `laser_freq`.
        #[size(RateBits)]
        laser_freq_meta: Rate,
        /// Second flip-flops of `laser_freq`.
        #[only_if(Hosted)]
        #[size(RateBits)]
        laser_freq_second: Rate,
        /// The same a cycle later.
        #[only_if(Hosted)]
        #[size(RateBits)]
        laser_freq_third: Rate,
        /// First flip-flop of `laser_en`.
        laser_en_meta: bool,
        /// First flip-flop of `dsp_en`.
        dsp_en_meta: bool,
        /// First flip-flop of `dsp_rst`.
        dsp_rst_meta: bool,
    }
}

/// Parameters that elaboration fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Whether a host controls the firmware, so that `laser_freq` is taken once two samples agree.
    pub is_hosted: bool,
}

impl Clocked for ControlSync {
    type In = In;
    type Params = Params;

    /// Shifts from the last stage to the first, so that each stage takes the old value of the one before it.
    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        if !p.is_hosted {
            self.laser_freq_sync = self.laser_freq_meta;
        } else {
            if self.laser_freq_second == self.laser_freq_third {
                self.laser_freq_sync = self.laser_freq_third;
            }
            self.laser_freq_third = self.laser_freq_second;
            self.laser_freq_second = self.laser_freq_meta;
        }
        self.mode_sync = self.mode_meta;
        self.laser_en_sync = self.laser_en_meta;
        self.dsp_en_sync = self.dsp_en_meta;
        self.dsp_rst_sync = self.dsp_rst_meta;
        self.mode_meta = i.mode;
        self.laser_freq_meta = i.laser_freq;
        self.laser_en_meta = i.laser_en;
        self.dsp_en_meta = i.dsp_en;
        self.dsp_rst_meta = i.dsp_rst;
    }

    #[inline(always)]
    fn quiet(&self, i: &In, p: &Params) -> u64 {
        asleep_if(self.next(i, p) == *self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_arrives_with_the_second_edge() {
        let i = In { laser_freq: Rate::new(2), dsp_en: true, ..In::default() };
        let p = Params { is_hosted: false };
        let first = ControlSync::default().next(&i, &p);
        assert_eq!(first.laser_freq_sync, 0);
        let second = first.next(&i, &p);
        assert_eq!(second.laser_freq_sync, 2);
        assert!(second.dsp_en_sync && !second.mode_sync);
    }

    #[test]
    fn with_a_host_a_rate_that_one_sample_has_is_not_taken() {
        let p = Params { is_hosted: true };
        let rates = [3, 3, 3, 3, 1, 2, 2, 2, 2, 2, 2];
        let mut sync = ControlSync::default();
        let taken = rates.map(|rate| {
            sync = sync.next(&In { laser_freq: Rate::new(rate), ..In::default() }, &p);
            sync.laser_freq_sync.get()
        });
        assert_eq!(taken, [0, 0, 0, 3, 3, 3, 3, 3, 2, 2, 2]);
    }
}
