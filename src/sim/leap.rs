//! Over whole stretches of a run at once: shots in which nothing but light decides, the clearing of
//! the histogram, and an estimation.
//!
//! The device lands where every further result is what stepping would have given. Registers that
//! nothing reads again may differ: the TDC does not keep the taps and codes of hits leapt over.

mod draws;
mod outcomes;

use std::sync::Arc;

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::Params;
use crate::firmware::vcsel_driver::PERIODS;
use crate::sensor::light::Light;

use super::device::Device;
use super::frames::Frames;
use super::setup::CYCLE;

pub use draws::Draws;
pub use outcomes::{NO_CODE, NO_HIT, OUTCOMES, Outcome, Outcomes};

/// Tables of outcomes, made when first needed: for each laser rate, in the dark and with the laser.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    draws: [[Option<Option<Arc<Draws>>>; 2]; PERIODS.len()],
}

impl Tables {
    /// The outcomes at a laser rate; `None` where shots are not independent, or where something else
    /// than the light of optics, which the TDC measures, decides.
    fn find(&mut self, rate: usize, lit: bool, p: &Params, light: &Light) -> Option<Arc<Draws>> {
        let Light::Optics(optics) = light else { return None };
        let make = || {
            let outcomes = Outcomes::new(&p.tdc, PERIODS[rate], CYCLE)?;
            Some(Arc::new(Draws::new(outcomes, optics.hazard(lit).clone())))
        };
        self.draws[rate][lit as usize].get_or_insert_with(make).clone()
    }
}

/// Cycles of Clear that are stepped at its begin, for what the end of the last frame leaves behind.
const CLEAR_BEGIN: u64 = 4;

impl Device {
    /// Leaps over as many shots as may be, but for the frame's last; the cycle of a laser edge has
    /// just been simulated. Does nothing where a shot is more than its first avalanche.
    pub fn leap_shots(&mut self, p: &Params, tables: &mut Tables, frames: &mut Frames) {
        let Some((rate, lit)) = self.independent_shot() else { return };
        let Some(draws) = tables.find(rate, lit, p, &self.light) else { return };
        let Light::Optics(optics) = &mut self.light else { return };
        let period = PERIODS[rate];
        let in_frame = u64::from(p.frame_ctrl.shots_per_frame) - self.top.frame_ctrl.shots() - 1;
        let until = self.timeline.next_event().since(self.pll.clk_125.rise(self.cycle));
        let shots = in_frame.min(until.fs() / (period * CYCLE.fs()));
        if shots == 0 {
            return;
        }
        let begun = self.pll.clk_125.rise(self.cycle - 1);
        let mut counts = [0u32; OUTCOMES.next_power_of_two()];
        counts[draws.outcome_at(self.spad.next_event() - begun) as usize] += 1;
        optics.pass(shots - 1, |word| {
            // The remainder is the outcome; it shows the compiler that it is within bounds.
            counts[draws.outcome(word) as usize % counts.len()] += 1;
        });
        self.top.land_at_laser_edge(rate, shots, &counts[..BINS]);
        self.cycle += shots * period;
        let now = self.pll.clk_125.rise(self.cycle - 1);
        self.light.begin_shot(now, lit);
        self.spad.arm(self.light.next_avalanche(now));
        self.line.settle_low();
        frames.leap(shots, shots - u64::from(counts[NO_HIT as usize]));
    }

    /// The laser rate of the shot that has just begun and whether the laser fires in those after it,
    /// if the first avalanche of each is all that decides, as long as no control signal changes.
    fn independent_shot(&self) -> Option<(usize, bool)> {
        let (top, now) = (&self.top, self.pll.clk_125.rise(self.cycle - 1));
        let rate = top.control_sync.laser_freq_sync.index();
        let lit = top.control_sync.laser_en_sync;
        let independent = self.steady_period() == Some(CYCLE)
            && top.vcsel_driver.registers.begins_shot(rate, lit)
            && !self.spad.is_passive()
            && self.spad.is_armed()
            && self.line.is_low_since(now - CYCLE);
        independent.then_some((rate, lit))
    }

    /// Leaps to the end of Clear or of an estimation, if one has just begun and nothing else goes on.
    pub fn leap_frame_end(&mut self, p: &Params) {
        let (clearing, estimating) = (
            self.top.frame_ctrl.clearing() == Some(CLEAR_BEGIN),
            self.top.estimation_phase(p) == Some(0),
        );
        let cycles = match (clearing, estimating) {
            (true, _) => BINS as u64 - 1 - CLEAR_BEGIN,
            (_, true) => p.estimator_cycles() - 1,
            _ => return,
        };
        let end = self.pll.clk_125.rise(self.cycle + cycles);
        let alone = self.jitter.is_none() && self.top.is_undisturbed(!estimating);
        if !alone || end >= self.timeline.next_event() {
            return;
        }
        if clearing {
            self.top.land_in_clear(cycles);
        } else {
            self.top.land_in_estimation(p);
        }
        self.cycle += cycles;
    }
}
