//! Measures the variants of a scenario, each once.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use tofsim::Note;
use tofsim::error::{Input, Result, poll_stop};
use tofsim::scenario::Loaded;
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::setup::Setup;

use crate::estimation::{EstimatorKind, Needs};

use super::bound::Bound;
use super::budget::{DepthBudget, EffectErrors};
use super::configured::estimator;
use super::effect::{Effect, EffectSet};
use super::figures::{ErrorChange, Errors};
use super::histograms::ROUNDINGS;
use super::simulated;
use super::state::{self, EffectState, EffectStates};
use super::variant::Variant;

/// Frames between two looks at whether to stop.
const BLOCK: u64 = 64;

/// Measurements to make.
#[derive(Clone, Debug)]
pub struct Plan {
    loaded: Loaded,
    setup: Setup,
    kind: EstimatorKind,
    states: EffectStates,
}

impl Plan {
    /// For a scenario, and an estimator that sees its histograms.
    ///
    /// # Errors
    /// When no depth can be that of the target, frames come in pairs or have no closed form for another reason
    /// than an effect, or the estimator cannot be made for it.
    pub fn new(loaded: &Loaded, kind: EstimatorKind) -> Result<Self> {
        let setup = Setup::of_counts(loaded.clone())?;
        let refused = |key: &str, expected: &str| {
            Input::new(format!("scenario {}", setup.name), expected).field(key)
        };
        if let Some(why) = setup.no_depth() {
            let expected = format!("{}; expected {} for an error budget", why.text, why.expected);
            return Err(refused(&why.key, &expected).value(&why.value).into());
        }
        if setup.has_pairs() || kind.needs() == Needs::Dark {
            let expected = "expected single frames and an estimator of these: an error budget has no dark ones";
            let key = if setup.has_pairs() { "firmware.dark_frames" } else { "--estimator" };
            let value = if setup.has_pairs() { "true" } else { kind.name() };
            return Err(refused(key, expected).value(value).into());
        }
        let apart = EffectSet::of(Effect::ALL).filter(|effect| !effect.joins_shots());
        let apart = Variant::new(loaded, apart.without(Effect::PllJitter))?;
        independent_shots(&apart.setup, "an error budget")?;
        let states = EffectStates::of(loaded, &setup, kind)?;
        Ok(Plan { loaded: loaded.clone(), setup, kind, states })
    }

    /// The scenario, ready to run.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Where the scenario lies outside of what the network was trained for, or the estimator takes for granted.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        let mut notes = state::domain_notes(self.kind, &self.setup)?;
        let drift = self.setup.drift_for(self.kind.is_network().then_some(&notes[..]));
        notes.extend(drift);
        notes.extend(self.kind.notes_of_scene(&self.setup));
        Ok(notes)
    }

    /// Frames that have to be drawn or simulated for so many of each variant.
    pub fn frames(&self, frames: u64) -> u64 {
        let drawn = self.wanted().into_iter().filter(|effects| effects.has(Effect::ShotNoise));
        drawn.count() as u64 * frames
    }

    /// Measures with so many frames of each variant, on all threads of the current pool; `done` hears of frames
    /// as they are done. The same for any number of threads.
    ///
    /// # Errors
    /// When it is stopped, or a variant cannot be made.
    pub fn measure(
        &self,
        frames: u64,
        stop: Option<&AtomicBool>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<DepthBudget> {
        let mut all = BTreeMap::new();
        for effects in self.wanted() {
            all.insert(effects, self.errors(effects, frames, stop, done)?);
        }
        let (base, rest, full) = (self.base(), self.rest(), self.full());
        let noise = base.with(Effect::ShotNoise);
        let of = |(effect, state): &(Effect, EffectState)| {
            let (effect, state) = (*effect, state.clone());
            let mut row =
                EffectErrors { effect, state, alone: None, all_but: None, adds: None, takes: None };
            if row.state != EffectState::On {
                return row;
            }
            let whole = if effect.joins_shots() { full } else { rest };
            if let Some(without) = self.without(whole, effect) {
                row.all_but = Some(all[&without].figures());
                row.takes = Some(all[&whole].change_from(&all[&without]));
            }
            if !effect.joins_shots() {
                let (quiet, noisy) = (&all[&base.with(effect)], &all[&noise.with(effect)]);
                let from = self.is_of_taps(effect);
                let [silent, drawn] =
                    [base, noise].map(|set| if from { set.with(Effect::Taps) } else { set });
                row.alone = Some(quiet.figures().with_spread_of(noisy.figures()));
                row.adds = Some(match effect {
                    Effect::ShotNoise => noisy.change_from(&all[&base]),
                    _ => ErrorChange {
                        variance_mm2: noisy.change_from(&all[&drawn]).variance_mm2,
                        variance_se_mm2: noisy.change_from(&all[&drawn]).variance_se_mm2,
                        ..quiet.change_from(&all[&silent])
                    },
                });
            }
            row
        };
        let effects: Vec<_> = self.states.iter().map(of).collect();
        let none = all[&base].figures();
        let added = |of: fn(&ErrorChange) -> Option<f64>| -> f64 {
            effects.iter().filter_map(|row| of(row.adds.as_ref()?)).sum()
        };
        Ok(DepthBudget {
            kind: self.kind,
            frames,
            distance_m: self.setup.scenario.target.distance_m,
            sum_mean_mm: none.mean_mm.unwrap_or(0.0) + added(|change| change.mean_mm),
            sum_two_sd_mm: 2.0 * added(|change| change.variance_mm2).max(0.0).sqrt(),
            none,
            effects,
            together: all[&full].figures(),
            bound: Bound::of(&self.setup)?,
        })
    }

    /// Returns the effects that are on in every variant.
    fn base(&self) -> EffectSet {
        self.states.left_out()
    }

    /// All effects that leave shots independent.
    fn rest(&self) -> EffectSet {
        self.full().filter(|effect| !effect.joins_shots())
    }

    /// All effects.
    fn full(&self) -> EffectSet {
        self.states.on_or_left_out()
    }

    /// Whether an effect has the width of taps as a part, so that what it adds is what it adds to that.
    fn is_of_taps(&self, effect: Effect) -> bool {
        matches!(effect, Effect::UnevenTaps | Effect::Calibration | Effect::Drift)
            && self.states.on().has(Effect::Taps)
    }

    /// All but an effect; `None` where another has it as a part: uneven taps, a wrong ROM and a drift are of taps.
    fn without(&self, whole: EffectSet, effect: Effect) -> Option<EffectSet> {
        let needs_taps = Effect::ALL.into_iter().any(|one| whole.has(one) && self.is_of_taps(one));
        (effect != Effect::Taps || !needs_taps).then(|| whole.without(effect))
    }

    /// All variants, each once.
    fn wanted(&self) -> Vec<EffectSet> {
        let (base, rest, full) = (self.base(), self.rest(), self.full());
        let mut wanted = vec![base, base.with(Effect::ShotNoise), rest, full];
        let on = Effect::ALL.into_iter().filter(|&effect| self.states.on().has(effect));
        for effect in on {
            let whole = if effect.joins_shots() { full } else { rest };
            wanted.extend(self.without(whole, effect));
            if !effect.joins_shots() {
                wanted.extend([base.with(effect), base.with(effect).with(Effect::ShotNoise)]);
            }
        }
        wanted.sort();
        wanted.dedup();
        wanted
    }

    /// The errors of a variant.
    fn errors(
        &self,
        effects: EffectSet,
        frames: u64,
        stop: Option<&AtomicBool>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Errors> {
        let variant = Variant::new(&self.loaded, effects)?;
        let estimator = estimator(self.kind, &variant)?;
        let error_mm = |histogram: &[u32]| {
            let depth_m = estimator.estimate(histogram).ok()?;
            Some(1e3 * (depth_m - self.setup.scenario.target.distance_m))
        };
        if effects.joins_shots() {
            let histograms = simulated::frames(&variant.setup, frames, stop, done)?;
            let of = histograms.par_iter().map(|histogram| error_mm(histogram)).collect();
            return Ok(Errors { of, is_drawn: true });
        }
        let histograms = variant.histograms();
        if !effects.has(Effect::ShotNoise) {
            let roundings = 0..ROUNDINGS;
            let of = roundings.map(|rounding| error_mm(&histograms.expected(rounding)));
            return Ok(Errors { of: of.collect(), is_drawn: false });
        }
        let (seed, mut of) = (self.setup.scenario.seed, Vec::with_capacity(frames as usize));
        for first in (0..frames).step_by(BLOCK as usize) {
            poll_stop(stop)?;
            let block = first..frames.min(first + BLOCK);
            let count = block.end - block.start;
            let drawn = block.into_par_iter().map(|frame| error_mm(&histograms.drawn(seed, frame)));
            of.par_extend(drawn);
            done(count);
        }
        Ok(Errors { of, is_drawn: true })
    }
}

#[cfg(test)]
mod tests;
