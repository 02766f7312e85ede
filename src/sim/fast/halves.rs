//! The top while it only acquires, as two halves: the emitter (laser, SPAD control, count of shots) and
//! the converter (TDC or its stand-in, histogram).
//!
//! Exact while `acquire` is high, resets and control signals stand still and the estimator rests. The
//! emitter's `start` is all that passes between the halves, so the converter goes first and sees what
//! it was. Either may be quiet.

use crate::firmware::carry_chain::{CarryChain, StopLine};
use crate::firmware::tdc::{self, Tdc};
use crate::firmware::tof_top::{CodeSource, Params, TofTop, Wires};
use crate::firmware::{code_preload, frame_ctrl, histogram_builder, spad_control, vcsel_driver};
use crate::kernel::{AWAKE, Clocked, Time};

/// Coming cycles in which nothing of the emitter would move but the laser's count.
#[inline(always)]
pub(super) fn emitter_quiet(top: &TofTop) -> u64 {
    match top.vcsel_driver.quiet(&laser_inputs(top)) {
        AWAKE => AWAKE,
        edges => edges.min(top.spad_control.quiet(&spad_inputs(top), &())),
    }
}

/// Coming cycles in which nothing of the converter would move but the coarse count, while `tdc_stop`
/// holds.
#[inline(always)]
pub(super) fn converter_quiet(top: &TofTop, p: &Params, line: &StopLine) -> u64 {
    if top.nets.tdc_valid | top.vcsel_driver.registers.start {
        return AWAKE;
    }
    match &p.code_source {
        CodeSource::Tdc => top.tdc.quiet(&tdc_inputs(top), &p.tdc, line),
        CodeSource::Preload(rom) => top.code_preload.quiet(&preload_inputs(top), rom),
    }
}

/// Whether the emitter has just given a sleeping converter something to do.
#[inline(always)]
pub(super) fn rouses_converter(top: &TofTop, line: &StopLine) -> bool {
    top.vcsel_driver.registers.start || !line.is_shown_by(&top.tdc.carry_chain.taps)
}

/// The converter's part of an edge at which both clocks rise.
#[inline(always)]
pub(super) fn convert(top: &mut TofTop, p: &Params, line: &mut StopLine, now: Time) {
    let (clear, read_en) = (false, false);
    let histogram = Wires::histogram_builder(top);
    top.histogram_builder.tick(&histogram_builder::In { clear, read_en, ..histogram });
    match &p.code_source {
        CodeSource::Tdc => {
            let i = tdc_inputs(top);
            convert_time(&mut top.tdc, &i, &p.tdc, line, now);
        }
        CodeSource::Preload(rom) => {
            top.code_preload = top.code_preload.next(&preload_inputs(top), rom);
        }
    }
    top.take_code(p);
}

/// The TDC's part, in place: the last block first, so that each reads what the one before it was, and
/// one that no edge would change is left alone.
#[inline(always)]
fn convert_time(tdc: &mut Tdc, i: &tdc::In, p: &tdc::Params, line: &mut StopLine, now: Time) {
    let decoder = tdc::Wires::tdc_decoder(tdc, i);
    if tdc.tdc_decoder.quiet(&decoder, &p.cal) == AWAKE {
        tdc.tdc_decoder.tick(&decoder, &p.cal);
    }
    let latch = tdc::Wires::tdc_latch(tdc, i);
    if tdc.tdc_latch.quiet(&latch, &p.tap_0) == AWAKE {
        tdc.tdc_latch.tick(&latch, &p.tap_0);
    }
    tdc.coarse_counter.tick(&tdc::Wires::coarse_counter(tdc, i), &());
    if !line.is_shown_by(&tdc.carry_chain.taps) {
        tdc.carry_chain = CarryChain { taps: line.sample(now, &p.delays) };
    }
}

/// The emitter's part of the same edge.
#[inline(always)]
pub(super) fn emit(top: &mut TofTop, p: &Params) {
    let laser = laser_inputs(top);
    if top.vcsel_driver.registers.start {
        let (rst, dsp_rst, algo_done) = (false, false, false);
        let i = frame_ctrl::In { rst, dsp_rst, algo_done, ..Wires::frame_ctrl(top) };
        top.frame_ctrl = top.frame_ctrl.next(&i, &p.frame_ctrl);
    }
    top.spad_control = top.spad_control.next(&spad_inputs(top), &());
    if pulse_is_near(top) {
        top.vcsel_driver.rise_250(&laser);
        top.drive_laser();
    }
    top.vcsel_driver.registers = top.vcsel_driver.registers.next(&laser, &());
}

/// The rest of the emitter's cycle: `clk_250` falls, rises and falls.
#[inline(always)]
pub(super) fn rest_of_cycle(top: &mut TofTop) {
    if pulse_is_near(top) {
        top.vcsel_driver.fall_250();
        top.vcsel_driver.rise_250(&laser_inputs(top));
        top.vcsel_driver.fall_250();
        top.drive_laser();
    }
}

/// Whether the coming edges of `clk_250`, up to the next one of `clk_125`, make or end a pulse.
#[inline(always)]
fn pulse_is_near(top: &TofTop) -> bool {
    let driver = &top.vcsel_driver;
    driver.registers.fire | driver.registers_250.laser_pulse | driver.ddr_output.q
}

/// Stands for that many cycles of the emitter, all of them quiet.
#[inline(always)]
pub(super) fn skip_emitter(top: &mut TofTop, cycles: u64) {
    top.vcsel_driver.skip(&laser_inputs(top), cycles);
}

/// Stands for that many cycles of the converter, all of them quiet.
#[inline(always)]
pub(super) fn skip_converter(top: &mut TofTop, cycles: u64) {
    top.tdc.skip(&tdc_inputs(top), cycles);
}

#[inline(always)]
fn laser_inputs(top: &TofTop) -> vcsel_driver::In {
    vcsel_driver::In { rst: false, rst_250: false, ..Wires::vcsel_driver(top) }
}

#[inline(always)]
fn spad_inputs(top: &TofTop) -> spad_control::In {
    spad_control::In { rst: false, ..Wires::spad_control(top) }
}

#[inline(always)]
fn tdc_inputs(top: &TofTop) -> tdc::In {
    tdc::In { rst: false, ..Wires::tdc(top) }
}

#[inline(always)]
fn preload_inputs(top: &TofTop) -> code_preload::In {
    code_preload::In { rst: false, ..Wires::code_preload(top) }
}
