//! Acquisition by parts: a fast way for most of a run, in which the same cycle repeats.
//!
//! Exact under the conditions of [`halves`](super::halves), with a clock without jitter; whatever ends those ends the
//! loop: the last shot, a change of a control signal, or the caller's limit. Each half sleeps as long as
//! it is quiet; an avalanche or a `start` wakes the converter. Cycles in which both sleep are
//! counted and not stepped.

use crate::firmware::tof_top::Params;
use crate::kernel::Time;
use crate::sim::device::{Device, Off};
use crate::sim::frames::Frames;

use super::halves::{converter_quiet, rouses_converter, skip_emitter};
use super::hits::Hits;
use super::idle::cycles_until_event;
use super::pulse::Pulse;
use super::steady::{control_is_steady, cycles_of_steady_control, estimator_rests, even_period};

/// Advances to `limit` or to the end of the acquisition, whichever is first [cycles of clk_sys]; does nothing outside
/// of an acquisition. `at_shot` may advance the device further in each cycle in which a shot has begun.
#[inline(always)]
pub fn acquire(
    device: &mut Device,
    p: &Params,
    frames: &mut Frames,
    limit: u64,
    mut at_shot: impl FnMut(&mut Device, &mut Frames, &mut Hits),
) {
    let Some(period) = even_period(device) else { return };
    if !device.top.frame_ctrl.acquire
        || !control_is_steady(&device.top, p)
        || !estimator_rests(&device.top, p)
    {
        return;
    }
    let limit = limit.min(device.cycle.saturating_add(cycles_of_steady_control(device, period)));
    let (mut emitter_wakes, mut converter_wakes) = (device.cycle, device.cycle);
    // The cycle that the converter has come to; it sleeps from there to the present one.
    let mut converter_at = device.cycle;
    let mut hits = Hits::default();
    let mut pulse = Pulse::new(&device.top, p);
    let mut now = device.pll.clk_sys.rise(device.cycle);
    while device.top.frame_ctrl.acquire && device.cycle < limit {
        while device.spads.next_event() <= now {
            device.detect(&mut Off);
            converter_wakes = device.cycle;
        }
        let emits = emitter_wakes <= device.cycle;
        if converter_wakes <= device.cycle {
            hits.skip(&mut device.top, p, device.cycle - converter_at);
            // No fast way is taken where the chain differs from edge to edge.
            let level = device.top.pins.tdc_stop;
            let taps = device.transitions.sample(level, now, &p.tdc.delays);
            hits.convert(&mut device.top, p, taps, device.cycle);
            frames.count_hit(&device.top);
            let quiet = converter_quiet(device, p);
            converter_at = device.cycle + 1;
            converter_wakes = converter_at.saturating_add(quiet);
        } else if !emits {
            let quiet = limit.min(emitter_wakes).min(converter_wakes) - device.cycle;
            let cycles = cycles_until_event(device, quiet, now, period);
            skip_emitter(&mut device.top, p, cycles);
            device.cycle += cycles;
            now += Time::from_fs(cycles * period.fs());
            continue;
        }
        device.cycle += 1;
        if !emits {
            skip_emitter(&mut device.top, p, 1);
            now += period;
            continue;
        }
        pulse.emit(device, p, now);
        emitter_wakes = device.cycle.saturating_add(pulse.emitter_quiet(&device.top, p));
        if rouses_converter(device) {
            converter_wakes = device.cycle;
        }
        now += period;
        if device.top.vcsel_driver.registers.start {
            frames.count_shot(&device.top);
            hits.skip(&mut device.top, p, device.cycle - converter_at);
            at_shot(device, frames, &mut hits);
            converter_at = device.cycle;
            emitter_wakes = device.cycle;
            now = device.pll.clk_sys.rise(device.cycle);
        }
    }
    hits.skip(&mut device.top, p, device.cycle - converter_at);
    hits.replay(&mut device.top, p, device.cycle);
    pulse.replay(&mut device.top, p, device.cycle);
}
