//! The firmware during an acquisition, as two halves: the emitter (laser, SPAD control, count of shots) and
//! the converter (TDC or its stand-in, histogram).
//!
//! Exact while `acquire` is high, resets and control signals stand still and the estimator rests. The
//! emitter's `start` is all that passes between the halves, so the converter goes first and sees what
//! it was. Either may be quiet.

use crate::firmware::carry_chain::Taps;
use crate::firmware::tof_top::{CodeSource, Params, TofTop, Wires};
use crate::firmware::{code_preload, frame_ctrl, histogram_builder, tdc, vcsel_driver};
use crate::kernel::{AWAKE, Clocked, asleep_if};
use crate::sim::device::Device;

/// Returns the number of next cycles in which only the laser's count moves in the emitter.
#[inline(always)]
pub(super) fn emitter_quiet(top: &TofTop, p: &Params) -> u64 {
    emitter_quiet_if(top, top.vcsel_driver.quiet(&laser_inputs(top), &p.vcsel_driver))
}

/// Returns [`emitter_quiet`] while no laser pulse is on its way.
#[inline(always)]
pub(super) fn emitter_quiet_without_pulse(top: &TofTop, p: &Params) -> u64 {
    emitter_quiet_if(top, top.vcsel_driver.registers.quiet(&laser_inputs(top), &p.vcsel_driver))
}

#[inline(always)]
fn emitter_quiet_if(top: &TofTop, laser_quiet: u64) -> u64 {
    if laser_quiet == AWAKE {
        return AWAKE;
    }
    laser_quiet.min(asleep_if(top.spad_control.is_recharged(&Wires::spad_control(top))))
}

/// Returns the number of next cycles in which only the coarse count and hits on their way to their words move in the
/// converter, while `tdc_stop` holds.
#[inline(always)]
pub(super) fn converter_quiet(device: &Device, p: &Params) -> u64 {
    let top = &device.top;
    match &p.code_source {
        CodeSource::Tdc if !taps_hold(device) => AWAKE,
        CodeSource::Tdc => top.tdc.quiet(&tdc_inputs(top), &p.tdc),
        CodeSource::Preload(rom) => top.code_preload.quiet(&preload_inputs(top), rom),
    }
}

/// Returns whether the emitter has just woken the converter.
#[inline(always)]
pub(super) fn rouses_converter(device: &Device) -> bool {
    device.top.vcsel_driver.registers.start || !taps_hold(device)
}

/// Returns whether every edge samples the same taps as the last one, while `tdc_stop` holds.
#[inline(always)]
fn taps_hold(device: &Device) -> bool {
    let top = &device.top;
    device.transitions.are_over(top.pins.tdc_stop, &top.tdc.carry_chain.taps)
}

/// Takes the converter's part of an edge at which both clocks rise.
#[inline(always)]
pub(super) fn convert(top: &mut TofTop, p: &Params, taps: Taps) {
    count(top, p);
    top.convert(p, &tdc_inputs(top), &preload_inputs(top), taps);
}

/// Takes the part of the converter that samples and keeps hits.
#[inline(always)]
pub(super) fn sample(top: &mut TofTop, p: &Params, taps: Taps) {
    top.tdc.sample(&tdc_inputs(top), &p.tdc, taps);
}

/// Takes the emitter's part of the same edge of `clk_sys`.
#[inline(always)]
pub(super) fn emit(top: &mut TofTop, p: &Params) {
    let laser = laser_inputs(top);
    if top.vcsel_driver.registers.start {
        let (rst, dsp_rst, algo_done) = (false, false, false);
        let i = frame_ctrl::In { rst, dsp_rst, algo_done, ..Wires::frame_ctrl(top) };
        top.frame_ctrl.tick(&i, &p.frame_ctrl);
    }
    top.spad_control.recharge(&Wires::spad_control(top));
    top.vcsel_driver.registers.tick(&laser, &p.vcsel_driver);
}

/// Takes the emitter's part of the edge of `clk_laser`; before [`emit`], whose `fire` it does not see yet.
#[inline(always)]
pub(super) fn emit_light(top: &mut TofTop, p: &Params) {
    top.vcsel_driver.rise_laser(&laser_inputs(top), &p.vcsel_driver);
    top.drive_laser();
}

/// Takes the rest of the cycle: `clk_laser` falls, rises and falls.
#[inline(always)]
pub(super) fn rest_of_cycle(top: &mut TofTop, p: &Params) {
    top.vcsel_driver.fall_laser();
    top.vcsel_driver.rise_laser(&laser_inputs(top), &p.vcsel_driver);
    top.vcsel_driver.fall_laser();
    top.drive_laser();
}

/// Skips quiet cycles of the emitter.
#[inline(always)]
pub(super) fn skip_emitter(top: &mut TofTop, p: &Params, cycles: u64) {
    top.vcsel_driver.skip(&laser_inputs(top), &p.vcsel_driver, cycles);
}

/// Skips quiet cycles of the converter.
#[inline(always)]
pub(super) fn skip_converter(top: &mut TofTop, p: &Params, cycles: u64) {
    count_hits(top, p, cycles);
    skip_sampling(top, p, cycles);
}

/// Skips quiet cycles of the part of the converter that samples and keeps hits.
#[inline(always)]
pub(super) fn skip_sampling(top: &mut TofTop, p: &Params, cycles: u64) {
    if let CodeSource::Tdc = p.code_source {
        top.tdc.skip(&tdc_inputs(top), &p.tdc, cycles);
    }
}

/// Advances hits that the TDC has kept by `cycles` towards their words.
#[inline(always)]
pub(super) fn count_hits(top: &mut TofTop, p: &Params, cycles: u64) {
    let mut left = cycles;
    while left > 0 && (top.tdc.has_hit() | top.histogram_builder.has_hit()) {
        count(top, p);
        if let CodeSource::Tdc = p.code_source {
            top.tdc.decode(&tdc_inputs(top), &p.tdc);
            top.take_code();
        }
        left -= 1;
    }
}

/// Takes the histogram's part of an edge while nothing is read.
#[inline(always)]
pub(super) fn count(top: &mut TofTop, p: &Params) {
    let (clear, read_en) = (false, false);
    let histogram = Wires::histogram_builder(top);
    top.histogram_builder
        .tick(&histogram_builder::In { clear, read_en, ..histogram }, &p.histogram);
}

#[inline(always)]
fn laser_inputs(top: &TofTop) -> vcsel_driver::In {
    vcsel_driver::In { rst: false, rst_laser: false, ..Wires::vcsel_driver(top) }
}

#[inline(always)]
fn tdc_inputs(top: &TofTop) -> tdc::In {
    tdc::In { rst: false, ..Wires::tdc(top) }
}

#[inline(always)]
fn preload_inputs(top: &TofTop) -> code_preload::In {
    code_preload::In { rst: false, ..Wires::code_preload(top) }
}
