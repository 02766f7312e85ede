//! The time-to-digital converter: wires its four blocks.
//!
//! Mirrors `rtl_ref/tdc.v`.
//!
//! ```text
//! tdc_stop ─► carry_chain ─► tdc_latch ─► tdc_decoder ─► tdc_code, tdc_valid
//! start ────► coarse_counter ──┘
//! edge             e            e+1        e+2 .. e+7
//! ```

use crate::kernel::Clocked;
use crate::{connect, signals};

use super::carry_chain::{self, CarryChain, Delays, Taps};
use super::coarse_counter::{self, CoarseCounter, DEFAULT_COARSE_BITS};
use super::tdc_decoder::{self, Decoder, Encoder, TdcDecoder, TimeScale};
use super::tdc_latch::{self, TdcLatch};

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A shot begins.
        pub start: bool,
        /// Output of the SPAD, asynchronous.
        pub tdc_stop: bool,
        /// Every hit counts, whatever the shot: those of a calibration.
        #[only_if(Calibrated)]
        pub free: bool,
        /// Age for the last hit's `n` by the last calibration, where there are any [units].
        #[only_if(Calibrated)]
        #[size(AgeBits)]
        pub calibrated_age: tdc_decoder::Age,
    }
}

/// Parameters that elaboration and placement fix.
#[derive(Clone, Debug)]
pub struct Params {
    /// Delays of the chain.
    pub delays: Delays,
    /// Length of the window.
    pub coarse_counter: coarse_counter::Params,
    /// ROM of the decoder, how it counts, and in how many steps.
    pub decoder: tdc_decoder::Params,
    /// Place of physical tap 0 in the order of arrival.
    tap_0: usize,
}

impl Params {
    /// For a chain, with the ones count and the ROM that goes with it, what times count, a coarse count of so many
    /// bits, and 2 or 3 registers of the ones count.
    pub fn new(delays: Delays, scale: TimeScale, coarse_bits: u32, count_stages: u64) -> Self {
        let tap_0 = delays.tap_0_position();
        let cal = tdc_decoder::Params::calibration(&delays, Decoder::Ones, &scale);
        let encoder = Encoder::new(Decoder::Ones, &delays);
        let decoder = tdc_decoder::Params { cal, count_stages, scale, encoder, calibrated: None };
        Params { delays, coarse_counter: coarse_counter::Params { coarse_bits }, decoder, tap_0 }
    }

    /// Returns the TDC with another decoder, and the ROM that goes with the chain and it.
    pub fn with_decoder(self, decoder: Decoder) -> Self {
        let cal = tdc_decoder::Params::calibration(&self.delays, decoder, &self.decoder.scale);
        let encoder = Encoder::new(decoder, &self.delays);
        Params { decoder: tdc_decoder::Params { cal, encoder, ..self.decoder }, ..self }
    }

    /// Returns the TDC with another ROM, as long as the chain's own.
    pub fn with_calibration(self, cal: tdc_decoder::Calibration) -> Self {
        Params { decoder: tdc_decoder::Params { cal, ..self.decoder }, ..self }
    }

    /// Returns the TDC with ages from a calibration of so many hits, as a power of two.
    pub fn calibrated(self, hits_log2: u32) -> Self {
        Params {
            decoder: tdc_decoder::Params { calibrated: Some(hits_log2), ..self.decoder },
            ..self
        }
    }

    /// Returns the TDC with its ROM behind a chain of as many taps with other delays.
    pub fn with_delays(self, delays: Delays) -> Self {
        let encoder = Encoder::new(self.decoder.encoder.decoder(), &delays);
        let decoder = tdc_decoder::Params { encoder, ..self.decoder };
        Params { tap_0: delays.tap_0_position(), delays, decoder, ..self }
    }

    /// Returns the TDC with its ROM behind a chain of as many taps that come in the order of their numbers.
    pub fn in_order(self, delays: Delays) -> Self {
        let encoder = Encoder::new(Decoder::Ones, &delays);
        let decoder = tdc_decoder::Params { encoder, ..self.decoder };
        Params { tap_0: delays.tap_0_position(), delays, decoder, ..self }
    }

    /// The KC705's but for the chain.
    pub fn of_chain(delays: Delays) -> Self {
        Params::new(delays, TimeScale::default(), DEFAULT_COARSE_BITS, tdc_decoder::COUNT_STAGES)
    }

    /// The last edge after the laser's that samples hits with a code, within the window.
    pub fn last_coded(&self) -> u64 {
        self.decoder.last_coded().min(self.coarse_counter.window())
    }
}

/// The blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tdc {
    /// Delay line and its registers.
    pub carry_chain: CarryChain,
    /// Cycles of the shot.
    pub coarse_counter: CoarseCounter,
    /// First hit of the shot.
    pub tdc_latch: TdcLatch,
    /// Code of the hit.
    pub tdc_decoder: TdcDecoder,
}

connect! {
    /// Port connections.
    pub struct Wires in tdc (this: &Tdc, i: &In) {
        output [tdc_code, tdc_valid, n, n_valid] <- this.tdc_decoder;
    }
    carry_chain(clk_sys): carry_chain::In {
        tdc_stop <- i.tdc_stop;
    }
    coarse_counter(clk_sys): coarse_counter::In {
        [rst, start] <- i;
    }
    tdc_latch(clk_sys): tdc_latch::In {
        [rst, start] <- i;
        window <- this.coarse_counter.window;
        free <- i.free;
        coarse <- this.coarse_counter.coarse;
        taps <- this.carry_chain.taps;
    }
    tdc_decoder(clk_sys): tdc_decoder::In {
        rst <- i.rst;
        [hit, hit_coarse, hit_taps] <- this.tdc_latch;
        calibrated_age <- i.calibrated_age;
    }
}

impl Tdc {
    /// Takes a rising edge of `clk_sys`, at which the chain's registers sample `taps`: from the end of the pipeline on,
    /// so that each block takes what the one before it was.
    #[inline(always)]
    pub fn rise(&mut self, i: &In, p: &Params, taps: Taps) {
        self.tdc_decoder.tick(&Wires::tdc_decoder(self, i), &p.decoder);
        self.sample(i, p, taps);
    }

    /// Takes the edge's part of all blocks before the decoder.
    #[inline(always)]
    pub fn sample(&mut self, i: &In, p: &Params, taps: Taps) {
        self.tdc_latch.tick(&Wires::tdc_latch(self, i), &p.tap_0);
        self.coarse_counter.tick(&Wires::coarse_counter(self, i), &p.coarse_counter);
        self.carry_chain = CarryChain { taps };
    }

    /// Coming edges at which, while the inputs and the sampled taps hold, nothing before the decoder would move but
    /// the coarse count.
    #[inline(always)]
    pub fn quiet(&self, i: &In, p: &Params) -> u64 {
        let tdc_latch = self.tdc_latch.quiet(&Wires::tdc_latch(self, i), &p.tap_0);
        let coarse_counter = &Wires::coarse_counter(self, i);
        tdc_latch.min(self.coarse_counter.quiet(coarse_counter, &p.coarse_counter))
    }

    /// Stands for that many edges of all before the decoder, all of them quiet.
    #[inline(always)]
    pub fn skip(&mut self, i: &In, p: &Params, edges: u64) {
        self.coarse_counter.skip(&Wires::coarse_counter(self, i), &p.coarse_counter, edges);
        self.tdc_latch.skip(&Wires::tdc_latch(self, i), &p.tap_0, edges);
    }

    /// Returns whether a hit is on its way to its code, or a code is new.
    #[inline(always)]
    pub fn has_hit(&self) -> bool {
        self.tdc_latch.hit | self.tdc_decoder.has_hit()
    }

    /// The decoder's part of an edge at which nothing before it moves but the fall of `hit`.
    #[inline(always)]
    pub fn decode(&mut self, i: &In, p: &Params) {
        let i = Wires::tdc_decoder(self, i);
        self.tdc_decoder.tick(&i, &p.decoder);
        self.tdc_latch.hit = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::carry_chain::{TAPS, Transitions};
    use crate::kernel::Time;

    /// The code of a photon, with the laser edge at edge 10, and the cycle of `tdc_valid`.
    fn code_of(photon_fs: u64, count_stages: u64) -> Option<(u64, u64)> {
        let delays = Delays::new(Time::from_fs(2_230_000), &[11_500; TAPS]).unwrap();
        let params = Params::new(delays, TimeScale::default(), DEFAULT_COARSE_BITS, count_stages);
        let (mut tdc, mut transitions) = (Tdc::default(), Transitions::default());
        let mut tdc_stop = false;
        let photon = Time::from_ns(80) + Time::from_fs(photon_fs);
        for edge in 0..30 {
            let now = Time::from_ns(8 * edge);
            if photon <= now && !tdc_stop {
                tdc_stop = true;
                transitions.push(photon);
            }
            let i = In { start: edge == 11, tdc_stop, ..In::default() };
            let taps = transitions.sample(tdc_stop, now, &params.delays);
            tdc.rise(&i, &params, taps);
            if tdc.tdc_decoder.tdc_valid {
                return Some((edge, tdc.tdc_decoder.tdc_code.get()));
            }
        }
        None
    }

    #[test]
    fn a_photon_on_the_laser_edge_has_code_0() {
        assert_eq!(code_of(0, 3), Some((11 + 7, 0)));
        assert_eq!(code_of(0, 2), Some((11 + 6, 0)));
    }

    #[test]
    fn the_code_is_up_seven_edges_after_the_one_that_samples_the_taps() {
        assert_eq!(code_of(3_300_000, 3), Some((11 + 7, 132)));
        assert_eq!(code_of(5_770_000, 3), Some((11 + 7, 230)), "reaches the chain at edge 11");
        assert_eq!(code_of(5_770_001, 3), Some((12 + 7, 230)), "reaches the chain after it");
    }

    #[test]
    fn a_photon_past_the_range_has_no_code() {
        assert!(code_of(6_385_000, 3).is_some());
        assert_eq!(code_of(6_415_000, 3), None);
    }
}
