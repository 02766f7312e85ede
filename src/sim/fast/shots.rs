//! Shots of an undisturbed acquisition, each as one leap: a draw, a code and a count.
//!
//! Exact where the first avalanche of a shot is all that decides: the light of optics, the same in every shot,
//! MODE 0, diodes that only fire (an afterpulse of one shot may be the first avalanche of the next), a chain that
//! is clear in time, no control signal that changes. Registers that nothing reads again may differ: the TDC lands
//! as after a reset.

use std::sync::Arc;

use crate::firmware::tdc::Tdc;
use crate::firmware::tof_top::{Params, TofTop};
use crate::firmware::vcsel_driver::{MOST_RATES, Rate};
use crate::sensor::light::Light;
use crate::sim::device::Device;
use crate::sim::frames::Frames;

use super::draws::{COUNTS, Draws};
use super::hits::Hits;
use super::outcomes::{NO_HIT, ShotOutcomes};
use super::steady::even_period;

/// Tables of outcomes, made when first needed: for each laser rate, in the dark and with the laser.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    draws: [[Option<Option<Arc<Draws>>>; 2]; MOST_RATES],
}

impl Tables {
    /// Returns the outcomes at a laser rate; `None` where shots are not independent, or where something else
    /// than the light of optics, which the TDC measures, decides.
    fn find(&mut self, rate: Rate, lit: bool, p: &Params, light: &Light) -> Option<Arc<Draws>> {
        let Light::Optics(optics) = light else { return None };
        let make = || {
            let hazard = optics.hazard(lit);
            if !hazard.variation().is_none() {
                return None;
            }
            let outcomes = ShotOutcomes::new(&p.tdc, p.vcsel_driver.period(rate))?;
            Some(Arc::new(Draws::new(outcomes, hazard.clone())))
        };
        self.draws[rate.index()][lit as usize].get_or_insert_with(make).clone()
    }
}

/// Leaps over as many shots as may be, but for the frame's last; [`acquire`](super::acquire) has just
/// come through the cycle of a laser edge. Does nothing where a shot is more than its first avalanche.
pub fn leap_shots(
    device: &mut Device,
    p: &Params,
    tables: &mut Tables,
    frames: &mut Frames,
    hits: &mut Hits,
) {
    if device.spads.row().is_some() {
        return;
    }
    let Some((rate, lit)) = independent_shot(device) else { return };
    let Some(draws) = tables.find(rate, lit, p, &device.light) else { return };
    let Light::Optics(optics) = &mut device.light else { return };
    let period = p.vcsel_driver.period(rate);
    let in_frame = u64::from(p.frame_ctrl.shots_per_frame) - device.top.frame_ctrl.shots() - 1;
    let until = device.timeline.next_event().since(device.pll.clk_sys.rise(device.cycle));
    let shots = in_frame.min(until.fs() / (period * device.pll.cycle.fs()));
    if shots == 0 {
        return;
    }
    let begun = device.pll.clk_sys.rise(device.cycle - 1);
    let mut counts = [0; COUNTS];
    counts[draws.outcome_at(device.spads.next_event() - begun) as usize] += 1;
    optics.pass(shots - 1, |words| draws.count(words, &mut counts));
    hits.finish(&mut device.top, p);
    land(&mut device.top, shots, &counts);
    device.cycle += shots * period;
    let now = device.pll.clk_sys.rise(device.cycle - 1);
    device.light.begin_shot(now, lit);
    device.spads.arm_all(device.light.next_avalanche(now, 1.0));
    device.rest_stop();
    frames.shots += shots;
    frames.tdc_hits += shots - u64::from(counts[NO_HIT as usize]);
}

/// Returns the laser rate of the shot that has just begun and whether the laser fires in those after it, if
/// the first avalanche of each is all that decides. Control signals have held since before the laser
/// edge: they are what the driver took with it, and the SPAD's output fell a cycle before it at last.
fn independent_shot(device: &Device) -> Option<(Rate, bool)> {
    let control = &device.top.control_sync;
    let (rate, lit) = (control.laser_freq_sync, control.laser_en_sync);
    let independent =
        !device.spads.is_passive() && device.spads.is_armed() && even_period(device).is_some();
    independent.then_some((rate, lit))
}

/// Sets the top to the cycle of a laser edge, `shots` shots later, which have counted `counts`.
fn land(top: &mut TofTop, shots: u64, counts: &[u32]) {
    for (word, &count) in top.histogram_builder.ram.iter_mut().zip(counts) {
        *word = *word + u64::from(count);
    }
    top.frame_ctrl.shots = top.frame_ctrl.shots + shots;
    top.tdc = Tdc::default();
    top.nets.tdc_valid = false;
}
