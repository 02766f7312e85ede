//! The device: its modules and the wires between them.
//!
//! Mirrors `rtl_ref/tof_top.v`. It only wires; time and light are the business of who steps it
//! (see [`crate::sim`]).

use crate::connect;
use crate::kernel::Clocked;

use super::carry_chain::Taps;
use super::centroid_estimator::{self, CentroidEstimator};
use super::code_preload::{self, CodePreload};
use super::control_sync::{self, ControlSync};
use super::ddr_output::DdrOutput;
use super::depth_estimator::{self, DepthEstimator};
use super::frame_ctrl::{self, FrameCtrl};
use super::histogram_builder::{self, HistogramBuilder};
use super::histogram_preload::{self, HistogramPreload};
use super::laser_guard::{self, LaserGuard};
use super::likelihood_estimator::{self, LikelihoodEstimator};
use super::registers::{self, RegisterFile};
use super::reset_sync::{self, ResetSync};
use super::spad_control::{self, SpadControl};
use super::tdc::{self, Tdc};
use super::tdc_calibration::{self, TdcCalibration};
use super::uart_bridge::{self, UartBridge};
use super::vcsel_driver::{self, VcselDriver};
use super::{lvds_output, pll};

pub mod channel;
pub mod estimator_params;
mod estimators;
mod nets;
mod ports;
mod scanned;
mod sizes;
pub mod slot;
pub mod slot_inputs;
pub mod slotted;
pub mod status;
pub mod status_code;

use channel::Channel;
pub use estimators::FirmwareEstimator;
pub use ports::{Clocks, CodeSource, HistogramSource, Nets, Params, Pins};
use slot::SlotOut;
use slot_inputs::SlotInputs;

/// The state of the firmware.
#[derive(Clone, Debug, Default)]
pub struct TofTop {
    /// Input pins.
    pub pins: Pins,
    /// Clock levels.
    pub clocks: Clocks,
    /// Combinational wires.
    pub nets: Nets,
    /// PLL outputs beside the clocks.
    pub pll: pll::Out,
    /// Reset in `clk_sys`.
    pub reset_sync_sys: ResetSync,
    /// Reset in `clk_laser`.
    pub reset_sync_laser: ResetSync,
    /// The acquisition computer's signals in `clk_sys`.
    pub control_sync: ControlSync,
    /// Frame sequence.
    pub frame_ctrl: FrameCtrl,
    /// Laser.
    pub vcsel_driver: VcselDriver,
    /// Laser pins.
    pub lvds_output: lvds_output::Out,
    /// SPAD.
    pub spad_control: SpadControl,
    /// Converter.
    pub tdc: Tdc,
    /// Calibration of the converter.
    pub tdc_calibration: TdcCalibration,
    /// Its stand-in.
    pub code_preload: CodePreload,
    /// Histogram.
    pub histogram_builder: HistogramBuilder,
    /// The histogram that is read while that one is filled, and the other way round.
    pub second_bank: HistogramBuilder,
    /// The other columns of an array.
    pub channels: Vec<Channel>,
    /// Its stand-in.
    pub histogram_preload: HistogramPreload,
    /// Neural estimator.
    pub depth_estimator: DepthEstimator,
    /// Centroid estimator.
    pub centroid_estimator: CentroidEstimator,
    /// Likelihood estimator.
    pub likelihood_estimator: LikelihoodEstimator,
    /// Serial line of a host, which runs do not have.
    pub uart_bridge: UartBridge,
    /// Its registers.
    pub registers: RegisterFile,
    /// Guard of the laser.
    pub laser_guard: LaserGuard,
    /// Outputs of the estimator in use.
    pub slot: SlotOut,
    /// Inputs at which the estimator in the slot rests, if it does: no edge changes it until one of them changes.
    pub(crate) rest: Option<SlotInputs>,
    /// Times that an estimator may have changed: edges at which the one in the slot did not rest, and accesses from
    /// outside.
    pub(crate) estimator_changes: u64,
}

connect! {
    /// Port connections. Every module output is a register, so one pass settles them.
    pub struct Wires in tof_top (this: &TofTop) {
        signals clocks, pins, nets;
        wire rst_sys <- this.reset_sync_sys.rst_sync;
        wire rst_laser <- this.reset_sync_laser.rst_sync;
        wire [mode_sync, laser_freq_sync, laser_en_sync] <- this.control_sync;
        wire [dsp_en_sync, dsp_rst_sync] <- this.control_sync;
        wire [clear, clear_addr, acquire, algo_start] <- this.frame_ctrl;
        wire [bank, row] <- this.frame_ctrl;
        wire [pre_start, start] <- this.vcsel_driver.registers;
        wire [read_en, read_addr] <- this.slot;
        output laser_on_lvds_p <- this.lvds_output.o;
        output laser_on_lvds_n <- this.lvds_output.ob;
        output ring_on <- this.tdc_calibration.registers.ring_on;
        output [spad_rst, spad_sel] <- this.spad_control;
        output [depth, sigma, status, valid] <- this.slot.words;
        output [second_depth, second_sigma] <- this.slot.words.second;
        output [second_strength, second_status, second_valid] <- this.slot.words.second;
        output algo_done <- this.slot.algo_done;
        output hist_valid <- this.slot.read_en;
        output hist_bin <- this.slot.read_addr;
        output hist_count <- this.nets.count;
        output [frame_done, depth_row, depth_column] <- this.frame_ctrl;
        output locked <- this.pll.locked;
        output uart_tx <- this.uart_bridge.uart_tx;
        output armed <- this.laser_guard.registers.armed;
    }
    pll(clk_in): pll::In {} -> { clk_sys: this.clocks.clk_sys, clk_laser: this.clocks.clk_laser, }
    reset_sync_sys(clk <- clk_sys): reset_sync::In {
        rst <- this.pins.rst;
        locked <- this.pll.locked;
    }
    reset_sync_laser(clk <- clk_laser): reset_sync::In {
        rst <- this.pins.rst;
        locked <- this.pll.locked;
    }
    control_sync(clk_sys): control_sync::In {
        [mode, laser_freq, laser_en, dsp_en, dsp_rst] <- this.pins;
    }
    frame_ctrl(clk_sys): frame_ctrl::In {
        rst <- this.reset_sync_sys.rst_sync;
        start <- this.vcsel_driver.registers.start;
        dsp_rst <- this.control_sync.dsp_rst_sync;
        dsp_en <- this.control_sync.dsp_en_sync;
        algo_done <- this.slot.algo_done;
        calibrating <- this.tdc_calibration.registers.calibrating;
    }
    vcsel_driver(clk_sys, clk_laser): vcsel_driver::In {
        rst <- this.reset_sync_sys.rst_sync;
        rst_laser <- this.reset_sync_laser.rst_sync;
        acquire <- this.frame_ctrl.acquire;
        laser_en <- this.control_sync.laser_en_sync;
        laser_freq <- this.control_sync.laser_freq_sync;
        laser_off <- this.laser_guard.registers.laser_off;
        laser_block <- this.laser_guard.registers_laser.laser_block;
    }
    lvds_output(): lvds_output::In {
        i <- this.vcsel_driver.ddr_output.q;
    }
    spad_control(clk_sys): spad_control::In {
        rst <- this.reset_sync_sys.rst_sync;
        mode <- this.control_sync.mode_sync;
        pre_start <- this.vcsel_driver.registers.pre_start;
        row <- this.frame_ctrl.row;
    }
    tdc(clk_sys): tdc::In {
        rst <- this.nets.rst_dsp;
        start <- this.vcsel_driver.registers.start;
        tdc_stop <- this.pins.tdc_stop;
        free <- this.tdc_calibration.registers.ring_on;
        calibrated_age <- this.tdc_calibration.registers.calibrated_age;
    }
    tdc_calibration(clk_sys): tdc_calibration::In {
        rst <- this.nets.rst_dsp;
        [clear, frame_done] <- this.frame_ctrl;
        [n_valid, n] <- this.tdc.tdc_decoder;
    }
    code_preload(clk_sys): code_preload::In {
        rst <- this.nets.rst_dsp;
        start <- this.vcsel_driver.registers.start;
    }
    histogram_builder(clk_sys): histogram_builder::In {
        [clear, clear_addr, bank, depth_column] <- this.frame_ctrl;
        [tdc_valid, tdc_code] <- this.nets;
        [read_en, read_addr] <- this.slot;
    } -> { count: this.nets.count, }
    second_bank(clk_sys): histogram_builder::In {
        [clear, clear_addr, bank, depth_column] <- this.frame_ctrl;
        [tdc_valid, tdc_code] <- this.nets;
        [read_en, read_addr] <- this.slot;
    } -> { count: this.nets.count, }
    histogram_preload(): histogram_preload::In {
        read_addr <- this.slot.read_addr;
    } -> { count: this.nets.count, }
    depth_estimator(clk_sys): depth_estimator::In {
        rst <- this.nets.rst_dsp;
        algo_start <- this.frame_ctrl.algo_start;
        count <- this.nets.count;
    }
    centroid_estimator(clk_sys): centroid_estimator::In {
        rst <- this.nets.rst_dsp;
        algo_start <- this.frame_ctrl.algo_start;
        count <- this.nets.count;
    }
    likelihood_estimator(clk_sys): likelihood_estimator::In {
        rst <- this.nets.rst_dsp;
        algo_start <- this.frame_ctrl.algo_start;
        mode <- this.control_sync.mode_sync;
        depth_column <- this.frame_ctrl.depth_column;
        count <- this.nets.count;
    }
    uart_bridge(clk_sys): uart_bridge::In {
        rst <- this.reset_sync_sys.rst_sync;
        uart_rx <- this.pins.uart_rx;
        read_data <- this.registers.registers.read_data;
    }
    registers(clk_sys): registers::In {
        rst <- this.reset_sync_sys.rst_sync;
        [address, write_en, write_data] <- this.uart_bridge;
        [pins_selected, armed, interlock_sync, host_silent] <- this.laser_guard.registers;
        [unlocked, interlocked, pulse_too_long, rate_too_high] <- this.laser_guard.registers;
        start <- this.vcsel_driver.registers.start;
        tdc_valid <- this.nets.tdc_valid;
        [n_valid, n] <- this.tdc.tdc_decoder;
        calibrating <- this.tdc_calibration.registers.calibrating;
        acquire <- this.frame_ctrl.acquire;
        hist_valid <- this.slot.read_en;
        hist_bin <- this.slot.read_addr;
        hist_count <- this.nets.count;
        frame_done <- this.frame_ctrl.frame_done;
        [depth, sigma, status, valid, code] <- this.slot.words;
    }
    laser_guard(clk_sys, clk_laser): laser_guard::In {
        rst <- this.reset_sync_sys.rst_sync;
        rst_laser <- this.reset_sync_laser.rst_sync;
        locked <- this.pll.locked;
        [interlock, select_pins, laser_en] <- this.pins;
        heard <- this.uart_bridge.heard;
        [arm, disarm] <- this.registers.registers;
        laser_pulse <- this.vcsel_driver.registers_laser.laser_pulse;
    }
}

impl TofTop {
    /// The firmware at power-up, with its control pins at `pins`.
    pub fn new(pins: Pins, p: &Params) -> Self {
        let histogram_builder = HistogramBuilder::new(&p.histogram);
        let tdc_calibration = p.tdc_calibration.as_ref().map(TdcCalibration::new);
        let tdc_calibration = tdc_calibration.unwrap_or_default();
        let (second_bank, channels) = channel::beside(&p.histogram, &p.frame_ctrl.scan);
        let mut top = TofTop {
            pins,
            histogram_builder,
            second_bank,
            channels,
            tdc_calibration,
            ..TofTop::default()
        };
        top.settle(p);
        top
    }

    /// Takes an edge at which `clk_sys` and `clk_laser` rise and the delay line's registers sample `taps`. All inputs
    /// are read in the first block, before any register changes in the second: the order within a block decides
    /// nothing.
    #[inline(always)]
    pub fn rise(&mut self, p: &Params, taps: Taps) {
        let estimator = self.slot_inputs(p);
        let reset_sync_sys = Wires::reset_sync_sys(self);
        let reset_sync_laser = Wires::reset_sync_laser(self);
        let control_sync = Wires::control_sync(self);
        let frame_ctrl = Wires::frame_ctrl(self);
        let vcsel_driver = Wires::vcsel_driver(self);
        let spad_control = Wires::spad_control(self);
        let tdc_calibration = p.tdc_calibration.as_ref().map(|p| (Wires::tdc_calibration(self), p));
        let (tdc, code_preload) = (Wires::tdc(self), Wires::code_preload(self));
        let histogram_builder = Wires::histogram_builder(self);

        // First, because `scan` reads the inputs of an array by itself.
        if p.frame_ctrl.scan.has_one_histogram() {
            self.histogram_builder.tick(&histogram_builder, &p.histogram);
        } else {
            self.scan(p);
        }
        self.convert(p, &tdc, &code_preload, taps);
        if let Some((inputs, p)) = tdc_calibration {
            self.tdc_calibration.tick(&inputs, p);
        }
        self.spad_control.tick(&spad_control, &());
        self.vcsel_driver.rise(&vcsel_driver, &p.vcsel_driver);
        self.frame_ctrl.tick(&frame_ctrl, &p.frame_ctrl);
        self.control_sync.tick(&control_sync, &p.control_sync());
        self.reset_sync_laser.tick(&reset_sync_laser, &());
        self.reset_sync_sys.tick(&reset_sync_sys, &());
        if let Some(inputs) = estimator {
            self.estimate(p, inputs);
        }
        self.settle(p);
    }

    /// An edge at which only `clk_laser` rises: the middle of a cycle of `clk_sys`.
    #[inline(always)]
    pub fn rise_laser(&mut self, p: &Params) {
        if self.vcsel_driver.has_pulse() {
            self.vcsel_driver.rise_laser(&Wires::vcsel_driver(self), &p.vcsel_driver);
            self.drive_laser();
        }
        self.reset_sync_laser.tick(&Wires::reset_sync_laser(self), &());
    }

    /// Returns the state that a rising edge of `clk_laser` alone can change; more only follows from it.
    #[inline(always)]
    pub fn registers_laser(&self) -> (ResetSync, vcsel_driver::LaserRegisters, DdrOutput) {
        let driver = &self.vcsel_driver;
        (self.reset_sync_laser, driver.registers_laser, driver.ddr_output)
    }

    /// A falling edge of `clk_laser`.
    #[inline(always)]
    pub fn fall_laser(&mut self) {
        if self.nets.laser_on {
            self.vcsel_driver.fall_laser();
            self.drive_laser();
        }
    }
}

#[cfg(test)]
mod tests;
