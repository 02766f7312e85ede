//! Estimations of the likelihood estimator one after the other, for it and for each of its blocks.
//!
//! The histograms are drawn from scenes of the scenario's instrument, near and far, bright and dark, until one shows
//! what its kind is for: each reason to reject a depth, alone, or a word on either side of a limit. Between them
//! stand extreme ones: empty, full, all hits in one bin, every other bin full, random. Now and then an estimation is
//! started while one is busy, or a reset cuts it short, in each state in turn.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator, State};
use tofsim::firmware::tof_top::status::Status;
use tofsim::kernel::U;
use tofsim::sim::setup::Setup;

mod kinds;
mod outcome;
mod pairs;
pub mod part;
mod scenes;

use kinds::*;
use outcome::Outcome;

use super::cover::Cover;
use super::draw::Draw;
use super::setting::Setting;
use super::spec::FIRST_RESET;

/// States of the estimator, and with those of a second target.
const STATES: u64 = State::End as u64 + 1;
const STATES_OF_TWO: u64 = State::Swap as u64 + 1;
/// Every so many estimations is a whole one.
const WHOLE: u64 = 2;
/// So often a histogram is drawn that is of its kind.
const TRIES: u64 = 100;
/// Score or shots from a limit, so near to which a histogram is changed and no longer drawn anew; and changes tried.
const NEAR: u64 = 50;
const NUDGES: u64 = 250;
/// So often it is begun anew.
const STARTS: u64 = 8;

/// Estimations under way.
pub struct Estimations<'a> {
    setup: &'a Setup,
    params: &'a Params,
    histogram: Vec<u32>,
    /// Light of a cover glass in it, as a multiple of what the estimator takes it for.
    pedestal: f64,
    begun: u64,
    /// State in which this one is cut short, and how many cycles before it is.
    cut: Option<(u64, u64)>,
    cuts: bool,
    line: usize,
    over: bool,
    /// Whether the estimator under test may be faster: then ours is started only when it is idle.
    leads: bool,
    starts: Cover,
    resets: Cover,
    seen: Cover,
    modes: Cover,
    limits: Cover,
    pairs: Cover,
    blind: Cover,
}

impl<'a> Estimations<'a> {
    /// Of the setting's instrument; with `cuts` some end early.
    pub fn new(setting: &'a Setting, cuts: bool) -> Self {
        let setup = &setting.setup;
        let params = &*setup.params.estimators.likelihood_estimator;
        let has_second = params.has_second();
        let states = if cuts { 0..states(params) } else { 0..0 };
        // Behind a glass the scan expects the light that the fit finds: no echo fails by its score alone.
        let least = if params.glass.bins() > 0 { ANOTHER } else { LEAST };
        Estimations {
            setup,
            params,
            histogram: vec![0; params.histogram.bins],
            pedestal: 1.0,
            begun: 0,
            cut: None,
            cuts,
            line: 0,
            over: false,
            leads: setting.lead > 0,
            starts: Cover::new("start in state", states.clone()),
            resets: Cover::new("reset in state but idle", states.skip(1)),
            modes: Cover::new("shots armed and not", if cuts { 0..2 } else { 0..0 }),
            seen: Cover::new("depths without and with a status", if cuts { 0..2 } else { 0..0 }),
            limits: Cover::new(
                "sides of a limit",
                if cuts && !has_second { 2 * least..2 * KINDS } else { 0..0 },
            ),
            blind: Cover::new(
                "shots left at the end of a dark window, just enough and too few",
                if cuts { 0..2 } else { 0..0 },
            ),
            pairs: Cover::new(
                "fates of two echoes",
                if cuts && has_second { 0..FATES } else { 0..0 },
            ),
        }
    }

    /// The input ports of a cycle.
    pub fn next(&mut self, block: &LikelihoodEstimator, draw: &mut Draw) -> In {
        let state = block.state() as u64;
        let mut rst = self.line == FIRST_RESET;
        if let Some((at, wait)) = &mut self.cut
            && *at == state
        {
            rst |= *wait == 0;
            *wait = wait.saturating_sub(1);
        }
        self.line += 1;
        if block.registers.algo_done {
            self.seen.see(u64::from(!block.registers.valid));
            self.modes.see(block.registers.status.get() >> 6);
            let (left, least) =
                (block.likelihood_memory.registers.left.get(), self.params.least_left());
            let is_dark = block.registers.status.get() & u64::from(Status::NoEcho.bit()) != 0;
            self.blind.see_if(is_dark && left.abs_diff(least) <= 1, u64::from(left < least));
        }
        let idle = block.state() == State::Idle;
        let algo_start = draw.one_in(if idle { 3 } else { 64 }) && (idle || !self.leads);
        self.starts.see_if(algo_start && !rst, state);
        self.resets.see_if(rst, state);
        if rst {
            self.cut = None;
        } else if algo_start && idle {
            self.begin(draw);
        }
        let memory = &block.likelihood_memory.registers;
        let word = if memory.read_en { self.histogram[memory.read_addr.index()] } else { 0 };
        // Of the two estimations of unarmed shots one sees them while the one before is under way.
        let next = self.begun + 1;
        let unarmed = next / WHOLE % KINDS == UNARMED;
        let mode = unarmed && draw.one_in(if idle { 2 } else { 500 * (1 + next % WHOLE * 100) });
        In { rst, algo_start, mode, count: U::new(word.into()), ..In::default() }
    }

    /// Returns whether these lines and all that follow are drawn for one block alone: from the middle of
    /// `lines` on, once the estimator is idle. A few histograms reach few of the limits that its words have.
    pub fn over(&mut self, block: &LikelihoodEstimator, lines: usize) -> bool {
        self.over |= self.line >= lines / 2 && block.state() == State::Idle;
        self.over
    }

    /// Another histogram, and perhaps a state in which its estimation is cut short.
    fn begin(&mut self, draw: &mut Draw) {
        self.begun += 1;
        let kind = self.begun / WHOLE % KINDS;
        if self.params.glass.bins() > 0 {
            // Of kinds that do not depend on it, it is beyond what the estimator takes.
            let [least, most] = match kind {
                RISING => [0.3, 0.49],
                0 | FALLING => [2.02, 2.5],
                _ => [0.6, 1.8],
            };
            self.pedestal = least + (most - least) * (draw.below(1000) as f64 / 1000.0);
        }
        self.histogram =
            if self.cuts { self.of_kind(kind, draw) } else { self.histogram(kind, draw) };
        let states = states(self.params);
        let place = 1 + self.begun / WHOLE % (states - 1);
        let cut = self.cuts && self.begun < WHOLE * states && !self.begun.is_multiple_of(WHOLE);
        self.cut = cut.then(|| (place, draw.below(12)));
    }

    /// Draws histograms until one is of its kind.
    fn of_kind(&mut self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        if kind >= LEAST && self.params.has_second() {
            return self.of_fate(kind - LEAST, draw);
        }
        if kind >= LEAST {
            return self.at_limit(kind, draw);
        }
        let mut drawn = || self.histogram(kind, draw);
        let found = (1..TRIES).map(|_| drawn()).find(|one| Outcome::of(one, self.params).is(kind));
        found.unwrap_or_else(drawn)
    }

    /// Changes histograms that are near a limit, one after the other, until one is there: this side of it, or the other
    /// the next time.
    fn at_limit(&mut self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        let far = self.begun % WHOLE == 1;
        let mut found = self.nudged_to_limit(kind, far, draw);
        for _ in 1..STARTS {
            if found.1 == 0 {
                break;
            }
            found = self.nudged_to_limit(kind, far, draw);
        }
        self.limits.see_if(found.1 == 0, 2 * kind + u64::from(far));
        found.0
    }

    /// Draws histograms until one is near a limit, and moves the nearest there hit by hit. Returns it and how far from
    /// the limit it is still.
    fn nudged_to_limit(&self, kind: u64, far: bool, draw: &mut Draw) -> (Vec<u32>, u64) {
        let to_limit = |one: &[u32]| Outcome::of(one, self.params).to_limit(kind, far);
        let mut best = self.histogram(kind, draw);
        let mut from = to_limit(&best);
        for _ in 0..TRIES {
            if from.is_some_and(|(distance, _)| distance <= NEAR) {
                break;
            }
            let next = self.histogram(kind, draw);
            let to_it = to_limit(&next);
            let is_nearer = |(distance, _)| from.is_none_or(|(least, _)| distance < least);
            if to_it.is_some_and(is_nearer) {
                (from, best) = (to_it, next);
            }
        }
        let Some((mut distance, mut bin)) = from else { return (best, u64::MAX) };
        for _ in 0..NUDGES {
            if distance == 0 {
                break;
            }
            let next = if kind == CERTAIN {
                Self::moved(&best, draw)
            } else {
                self.nudged(&best, bin, draw)
            };
            let from = to_limit(&next).filter(|from| from.0 <= distance);
            if let Some(from) = from {
                ((distance, bin), best) = (from, next);
            }
        }
        (best, distance)
    }

    /// Returns the coverage.
    pub fn coverage(self) -> [Cover; 7] {
        [self.starts, self.resets, self.seen, self.modes, self.limits, self.blind, self.pairs]
    }
}

/// Returns the number of states of such an estimator.
fn states(params: &Params) -> u64 {
    if params.has_second() { STATES_OF_TWO } else { STATES }
}
