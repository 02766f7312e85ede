//! The tournament: many starts, of which ever fewer are trained ever longer, and a last one that is
//! trained with weights that follow its errors.
//!
//! All that decides how it goes on is [`TournamentState`], so that a training that was stopped and one
//! that was not end alike.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use tofsim::error::{Result, poll_stop};
use tofsim::network::float::Float;

use crate::quantize::Circuit;

use super::accuracy::{DistanceErrors, by_distance, worst};
use super::data::{Purpose, Samples, StageData, TrainingMaterial};
use super::equalise::{follow, ratios};
use super::features::Scaling;
use super::fold::fold;
use super::lm::{Lm, Problem, Stop};
use super::recipe::{Recipe, Stage};
use super::state::{BestBlock, CurvePoint, TournamentState};

/// Observer of a training.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Set when the user interrupts.
    pub stop: Option<&'a AtomicBool>,
    /// Called with the work done [histograms times epochs].
    pub done: &'a (dyn Fn(u64) + Sync),
    /// When to come back, so that the state can be saved; at least one epoch is made before.
    pub until: Option<Instant>,
}

/// A tournament and its data.
#[derive(Debug)]
pub struct Tournament<'a> {
    recipe: &'a Recipe,
    material: &'a dyn TrainingMaterial,
    seed: u64,
    /// State from which it continues.
    pub state: TournamentState,
    data: StageData,
    held_out: Option<StageData>,
    choice: OnceLock<Samples>,
}

impl<'a> Tournament<'a> {
    /// At the beginning, or where another left off.
    pub fn new(
        recipe: &'a Recipe,
        material: &'a dyn TrainingMaterial,
        seed: u64,
        resumed: Option<TournamentState>,
    ) -> Self {
        let draw = |purpose| material.draw(recipe, seed, purpose);
        let stage = resumed.as_ref().map_or(0, |state| state.stage);
        let samples = draw(Purpose::Stage(stage));
        let held_out = (recipe.validation > 0).then(|| draw(Purpose::Validation));
        let state = resumed.unwrap_or_else(|| {
            let scaling = Scaling::of(&samples.counts, &material.knots(recipe), recipe.inputs);
            let mut state = TournamentState::new(recipe, seed, scaling);
            [Some(&samples), held_out.as_ref()]
                .into_iter()
                .flatten()
                .for_each(|one| state.saw(one));
            state
        });
        Tournament {
            data: StageData::new(samples, &state.scaling),
            held_out: held_out.map(|samples| StageData::new(samples, &state.scaling)),
            choice: OnceLock::new(),
            recipe,
            material,
            seed,
            state,
        }
    }

    /// Whether all is done.
    pub fn is_over(&self) -> bool {
        self.in_finish() && self.state.block >= self.recipe.finish.blocks
    }

    fn in_finish(&self) -> bool {
        self.state.stage >= self.recipe.stages.len()
    }

    /// Epochs of the stage or block that is going on.
    fn target(&self) -> u64 {
        self.recipe.stage(self.state.stage).epochs
    }

    /// Epochs of all candidates that are still to be made, times their samples, of all there are.
    pub fn progress(&self) -> (u64, u64) {
        let (recipe, state) = (self.recipe, &self.state);
        let blocks = |place| if place < recipe.stages.len() { 1 } else { recipe.finish.blocks };
        let work = |place: usize, epochs: u64| {
            let Stage { candidates, samples, .. } = recipe.stage(place);
            candidates as u64 * samples * epochs
        };
        let whole = |place| work(place, blocks(place) as u64 * recipe.stage(place).epochs);
        let made = state.block as u64 * recipe.stage(state.stage).epochs + state.epochs;
        let begun: u64 = state.candidates.iter().map(|candidate| candidate.made).sum();
        let begun = begun * recipe.stage(state.stage).samples;
        let done = (0..state.stage).map(whole).sum::<u64>() + work(state.stage, made) + begun;
        (done, (0..=recipe.stages.len()).map(whole).sum())
    }

    /// Returns whether it is between two checkpoints of the recipe.
    pub fn is_between(&self) -> bool {
        self.state.candidates.iter().any(|candidate| candidate.made > 0)
    }

    /// Trains until the next checkpoint of the recipe, or until the watch has it come back; whether it
    /// got to the checkpoint.
    ///
    /// # Errors
    /// When a cost is no number, or the user stops. The state is good to go on from even then, if it
    /// [is between](Tournament::is_between) two checkpoints.
    pub fn advance(&mut self, watch: &Watch) -> Result<bool> {
        if self.is_over() {
            return Ok(true);
        }
        if self.in_finish() && self.state.epochs == 0 && !self.is_between() {
            self.reweigh();
        }
        let epochs = self.recipe.checkpoint_epochs.min(self.target() - self.state.epochs);
        self.train(epochs, watch)?;
        if self.state.candidates.iter().any(|candidate| candidate.made < epochs) {
            return Ok(false);
        }
        self.state.candidates.iter_mut().for_each(|candidate| candidate.made = 0);
        self.state.epochs += epochs;
        self.record();
        let resting = self.state.candidates.iter().all(|candidate| candidate.lm.stop.is_some());
        if self.state.epochs < self.target() && !resting {
            return Ok(true);
        }
        self.state.epochs = 0;
        if self.in_finish() {
            self.judge()?;
            self.state.block += 1;
        } else {
            self.next_stage();
        }
        Ok(true)
    }

    /// Adds to the learning curve, and lets those rest that gain too little.
    fn record(&mut self) {
        let (stage, block) = (self.state.stage, self.state.block);
        for candidate in &mut self.state.candidates {
            let (start, lm) = (candidate.start, &mut candidate.lm);
            let Lm { epochs, cost, mu, validation, .. } = *lm;
            let same = |point: &&CurvePoint| {
                (point.stage, point.block, point.start) == (stage, block, start)
            };
            if let Some(before) = self.state.curve.iter().rev().find(same)
                && before.cost - cost < self.recipe.least_gain * before.cost
            {
                lm.stop = lm.stop.or(Some(Stop::Gain));
            }
            let point =
                CurvePoint { stage, block, start, epochs, cost, mu, validation, ratio: None };
            self.state.curve.push(point);
        }
    }

    /// Trains every candidate for so many epochs, less those that it has made, or until the watch ends.
    fn train(&mut self, epochs: u64, watch: &Watch) -> Result<()> {
        let (recipe, data, scaling) = (self.recipe, &self.data, &self.state.scaling);
        let held_out = self.held_out.as_ref();
        let samples = recipe.stage(self.state.stage).samples;
        let any = AtomicBool::new(false);
        let is_late = || {
            let over = watch.until.is_some_and(|until| Instant::now() >= until);
            over && any.load(Ordering::Relaxed)
        };
        self.state.candidates.par_iter_mut().try_for_each(|candidate| {
            let weights = |data: &StageData| data.weights(recipe, &candidate.factors);
            let (weights, others) = (weights(data), held_out.map(weights).unwrap_or_default());
            let held_out = held_out.map(|data| data.problem(recipe, scaling, &others, None));
            let problem = data.problem(recipe, scaling, &weights, held_out.as_ref());
            while candidate.made < epochs {
                poll_stop(watch.stop)?;
                if is_late() {
                    return Ok(());
                }
                candidate.lm.epoch(&problem, &recipe.optimiser)?;
                candidate.made += 1;
                any.store(true, Ordering::Relaxed);
                (watch.done)(samples);
            }
            if candidate.lm.stop.is_some() {
                candidate.lm.cost = problem.cost(&candidate.lm.x);
            }
            Ok(())
        })
    }

    /// Keeps the best for the next stage, and draws its data.
    fn next_stage(&mut self) {
        let state = &mut self.state;
        state.stage += 1;
        state
            .candidates
            .sort_by(|a, b| a.lm.cost.total_cmp(&b.lm.cost).then(a.start.cmp(&b.start)));
        state.candidates.truncate(self.recipe.stage(state.stage).candidates);
        state.candidates.iter_mut().for_each(|one| one.lm.restart(&self.recipe.optimiser));
        let samples = self.material.draw(self.recipe, self.seed, Purpose::Stage(state.stage));
        state.saw(&samples);
        self.data = StageData::new(samples, &state.scaling);
    }

    /// Gives more weight to distances where the error is larger than the line has it.
    fn reweigh(&mut self) {
        let recipe = self.recipe;
        for candidate in &mut self.state.candidates {
            let problem = self.data.problem(recipe, &self.state.scaling, &[], None);
            let errors_m = problem.errors(&candidate.lm.x);
            let ratios = ratios(&self.data.distances_m, &errors_m, &recipe.weighting);
            follow(&mut candidate.factors, &ratios, &recipe.finish);
            candidate.lm.restart(&recipe.optimiser);
        }
    }

    /// Keeps the block if none was better at its worst distance, in fixed point. One that fits the words is
    /// better than any whose weights have to be saturated.
    fn judge(&mut self) -> Result<()> {
        let drawn = || self.material.draw(self.recipe, self.seed, Purpose::Choice);
        let choice = self.choice.get_or_init(drawn);
        for candidate in &self.state.candidates {
            let (start, block) = (candidate.start, self.state.block + 1);
            let folded = fold(&candidate.lm.x, self.recipe.neurons, &self.state.scaling);
            let circuit = Circuit::new(&folded, &self.recipe.formats)?;
            let saturated = circuit.saturated_weights > 0;
            let ratio = worst(&errors(&circuit, choice), &self.recipe.weighting);
            let point = self.state.curve.iter_mut().rev().find(|point| point.start == start);
            point.into_iter().for_each(|point| point.ratio = Some(ratio));
            let is_better = |best: &BestBlock| {
                if saturated == best.saturated { ratio < best.ratio } else { best.saturated }
            };
            if self.state.best.as_ref().is_none_or(is_better) {
                let x = candidate.lm.x.clone();
                self.state.best = Some(BestBlock { start, block, ratio, saturated, x });
            }
        }
        Ok(())
    }

    /// The network to keep: the best block, or the first candidate if none was made.
    pub fn result(&self) -> Float {
        let best = self.state.best.as_ref().map(|best| &best.x);
        let x = best.unwrap_or(&self.state.candidates[0].lm.x);
        fold(x, self.recipe.neurons, &self.state.scaling)
    }

    /// Errors of a network on histograms that neither training nor choice has seen, one a scene.
    pub fn test(&self, circuit: &Circuit) -> Vec<DistanceErrors> {
        let samples = self.material.draw(self.recipe, self.seed, Purpose::Test);
        errors(circuit, &samples)
    }
}

/// Errors by distance, with the firmware's formats bit for bit those of the firmware.
fn errors(circuit: &Circuit, samples: &Samples) -> Vec<DistanceErrors> {
    by_distance(samples, |histogram| circuit.depth_m(histogram))
}

#[cfg(test)]
mod tests;
