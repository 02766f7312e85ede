//! Short cuts through cycles that change little or nothing: they leave the registers as
//! [`TofTop::rise`] and the edges of `clk_250` after it would.
//!
//! While the top [only acquires](TofTop::only_acquires) it falls into two parts, either of which may
//! be quiet: the emitter (laser, SPAD control, count of shots) and the converter (TDC or its
//! stand-in, histogram). The emitter's `start` is all that passes between them, so the converter
//! goes first and sees what it was.

use crate::firmware::carry_chain::StopLine;
use crate::firmware::depth_estimator::DepthEstimator;
use crate::firmware::tdc::Tdc;
use crate::firmware::{code_preload, frame_ctrl, reset_sync, spad_control, tdc, vcsel_driver};
use crate::kernel::{ASLEEP, AWAKE, Clocked, Time, U, asleep_if};
use crate::network::estimate::estimate;

use super::{CodeSource, Estimator, HistogramSource, Params, TofTop, Wires, histogram_builder};

impl TofTop {
    /// Whether, as long as `acquire` is high and no pin but `tdc_stop` changes, edges change nothing
    /// but the emitter and the converter.
    pub fn only_acquires(&self) -> bool {
        self.frame_ctrl.acquire && self.is_undisturbed(true)
    }

    /// Coming cycles in which nothing of the emitter would move but the laser's count.
    #[inline(always)]
    pub fn emitter_quiet(&self) -> u64 {
        match self.vcsel_driver.quiet(&self.laser_inputs()) {
            AWAKE => AWAKE,
            edges => edges.min(self.spad_control.quiet(&self.spad_inputs(), &())),
        }
    }

    /// Coming cycles in which nothing of the converter would move but the coarse count, while
    /// `tdc_stop` holds.
    #[inline(always)]
    pub fn converter_quiet(&self, p: &Params, line: &StopLine) -> u64 {
        if self.nets.tdc_valid | self.vcsel_driver.registers.start {
            return AWAKE;
        }
        match &p.code_source {
            CodeSource::Tdc => self.tdc.quiet(&self.tdc_inputs(), &p.tdc, line),
            CodeSource::Preload(rom) => self.code_preload.quiet(&self.preload_inputs(), rom),
        }
    }

    /// Whether the emitter has just given a sleeping converter something to do.
    #[inline(always)]
    pub fn rouses_converter(&self, line: &StopLine) -> bool {
        self.vcsel_driver.registers.start || !line.is_shown_by(&self.tdc.carry_chain.taps)
    }

    /// The converter's part of an edge at which both clocks rise, while the top only acquires.
    #[inline(always)]
    pub fn convert_acquiring(&mut self, p: &Params, line: &mut StopLine, now: Time) {
        let (clear, read_en) = (false, false);
        let histogram = Wires::histogram_builder(self);
        self.histogram_builder.tick(&histogram_builder::In { clear, read_en, ..histogram });
        self.convert(p, &self.tdc_inputs(), &self.preload_inputs(), line, now);
        self.take_code(p);
    }

    /// The emitter's part of the same.
    #[inline(always)]
    pub fn emit_acquiring(&mut self, p: &Params) {
        let laser = self.laser_inputs();
        if self.vcsel_driver.registers.start {
            let (rst, dsp_rst, algo_done) = (false, false, false);
            let i = frame_ctrl::In { rst, dsp_rst, algo_done, ..Wires::frame_ctrl(self) };
            self.frame_ctrl = self.frame_ctrl.next(&i, &p.frame_ctrl);
        }
        self.spad_control = self.spad_control.next(&self.spad_inputs(), &());
        self.rise_250_acquiring();
        self.vcsel_driver.registers = self.vcsel_driver.registers.next(&laser, &());
    }

    /// An edge at which only `clk_250` rises, or the part of it where both do, while the top only
    /// acquires. Returns whether it may have changed anything.
    #[inline(always)]
    pub fn rise_250_acquiring(&mut self) -> bool {
        let pulse = self.vcsel_driver.is_pulse_near();
        if pulse {
            self.vcsel_driver.rise_250(&self.laser_inputs());
            self.drive_laser();
        }
        pulse
    }

    /// The rest of the emitter's cycle: `clk_250` falls, rises and falls.
    #[inline(always)]
    pub fn rest_acquiring(&mut self) {
        if self.vcsel_driver.is_pulse_near() {
            self.vcsel_driver.fall_250();
            self.vcsel_driver.rise_250(&self.laser_inputs());
            self.vcsel_driver.fall_250();
            self.drive_laser();
        }
    }

    /// Coming cycles in which nothing would move but hidden counters, whatever the top does, while
    /// all pins hold.
    pub fn quiet(&self, p: &Params, line: &StopLine) -> u64 {
        let frame_ctrl = self.frame_ctrl.quiet(&Wires::frame_ctrl(self), &p.frame_ctrl);
        if frame_ctrl == AWAKE || self.nets.rst_dsp {
            return AWAKE;
        }
        frame_ctrl
            .min(self.reset_sync_125.quiet(&Wires::reset_sync_125(self), &()))
            .min(self.reset_sync_250.quiet(&Wires::reset_sync_250(self), &()))
            .min(self.control_sync.quiet(&Wires::control_sync(self), &()))
            .min(asleep_if(self.estimator_asleep && !self.frame_ctrl.algo_start))
            .min(self.emitter_quiet())
            .min(self.converter_quiet(p, line))
    }

    /// Stands for that many cycles, all of them quiet.
    #[inline(always)]
    pub fn skip(&mut self, cycles: u64) {
        self.frame_ctrl.skip(&Wires::frame_ctrl(self), cycles);
        self.skip_emitter(cycles);
        self.skip_converter(cycles);
    }

    /// Stands for that many cycles of the emitter, all of them quiet.
    #[inline(always)]
    pub fn skip_emitter(&mut self, cycles: u64) {
        self.vcsel_driver.skip(&self.laser_inputs(), cycles);
    }

    /// Stands for that many cycles of the converter, all of them quiet.
    #[inline(always)]
    pub fn skip_converter(&mut self, cycles: u64) {
        self.tdc.skip(&self.tdc_inputs(), cycles);
    }

    /// Whether resets and control signals stand still, and so does the estimator if it `rests`.
    pub fn is_undisturbed(&self, rests: bool) -> bool {
        let released = |reset: &reset_sync::ResetSync, i: &reset_sync::In| {
            !reset.rst_sync && reset.quiet(i, &()) == ASLEEP
        };
        let estimator_asleep = self.estimator_asleep && !self.frame_ctrl.algo_start;
        (estimator_asleep || !rests)
            && !self.nets.rst_dsp
            && released(&self.reset_sync_125, &Wires::reset_sync_125(self))
            && released(&self.reset_sync_250, &Wires::reset_sync_250(self))
            && self.control_sync.quiet(&Wires::control_sync(self), &()) == ASLEEP
    }

    /// Lands in the cycle of a laser edge, `shots` shots after another, which have counted `counts`.
    pub fn land_at_laser_edge(&mut self, rate: usize, shots: u64, counts: &[u32]) {
        for (word, &count) in self.histogram_builder.ram.iter_mut().zip(counts) {
            *word = *word + u64::from(count);
        }
        self.frame_ctrl.leap_shots(shots);
        self.tdc = Tdc::at_laser_edge(vcsel_driver::PERIODS[rate]);
        self.nets.tdc_valid = false;
    }

    /// Lands in Clear so many cycles later, not past its end.
    pub fn land_in_clear(&mut self, cycles: u64) {
        let from = self.frame_ctrl.clear_addr.index();
        self.histogram_builder.ram[from..from + cycles as usize].fill(U::new(0));
        self.frame_ctrl.leap_clear(cycles);
    }

    /// Cycles since the edge that took `algo_start`, while the estimator in use works.
    pub fn estimation_phase(&self, p: &Params) -> Option<u64> {
        match p.estimator {
            Estimator::Network => self.depth_estimator.estimator_ctrl.phase(),
            Estimator::Centroid => self.centroid_estimator.registers.phase(),
        }
    }

    /// Lands in the cycle before the depth is ready, from the first cycle of an estimation.
    pub fn land_in_estimation(&mut self, p: &Params) {
        let words = match &p.histogram_source {
            HistogramSource::Builder => &*self.histogram_builder.ram,
            HistogramSource::Preload(rom) => rom,
        };
        match p.estimator {
            Estimator::Network => {
                let histogram = std::array::from_fn(|bin| words[bin].get() as u16);
                let l1_in = estimate(&p.depth_estimator, &histogram).l1_in;
                self.depth_estimator = DepthEstimator::before_done(l1_in, &p.depth_estimator);
            }
            Estimator::Centroid => self.centroid_estimator.run(words, &p.centroid_estimator),
        }
        self.take_depth(p);
        self.settle(p);
    }

    #[inline(always)]
    fn laser_inputs(&self) -> vcsel_driver::In {
        vcsel_driver::In { rst: false, rst_250: false, ..Wires::vcsel_driver(self) }
    }

    #[inline(always)]
    fn spad_inputs(&self) -> spad_control::In {
        spad_control::In { rst: false, ..Wires::spad_control(self) }
    }

    #[inline(always)]
    fn tdc_inputs(&self) -> tdc::In {
        tdc::In { rst: false, ..Wires::tdc(self) }
    }

    #[inline(always)]
    fn preload_inputs(&self) -> code_preload::In {
        code_preload::In { rst: false, ..Wires::code_preload(self) }
    }
}
