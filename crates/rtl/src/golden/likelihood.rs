//! Estimations of the likelihood estimator one after the other, for it and for each of its blocks.
//!
//! The histograms are drawn from scenes of the scenario's instrument, near and far, bright and dark, until one shows
//! what its kind is for: each reason to reject a depth, alone, or a word on either side of a limit. Between them
//! stand extreme ones: empty, full, all hits in one bin, every other bin full, random. Now and then an estimation is
//! started while one is busy, or a reset cuts it short, in each state in turn.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::words::BLOCKS;
use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator, State};
use tofsim::kernel::U;
use tofsim::optics::{BinProbabilities, Budget, Hazard};
use tofsim::sim::setup::Setup;

mod kinds;
mod outcome;
pub mod part;

use kinds::*;
use outcome::Outcome;

use super::cover::Cover;
use super::draw::Draw;
use super::setting::Setting;
use super::spec::FIRST_RESET;

/// States of the estimator.
const STATES: u64 = State::End as u64 + 1;
/// Every so many estimations is a whole one.
const WHOLE: u64 = 2;
/// So often a histogram is drawn that is of its kind.
const TRIES: u64 = 100;
/// Score or shots from a limit, so near to which a histogram is changed and no longer drawn anew; and changes tried.
const NEAR: u64 = 50;
const NUDGES: u64 = 250;
/// So often it is begun anew.
const STARTS: u64 = 8;
/// Changes that make an even histogram uneven.
const SHAKES: u64 = 300;
/// Kinds of extreme histograms.
const EXTREMES: u64 = 8;

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
}

impl<'a> Estimations<'a> {
    /// Of the setting's instrument; with `cuts` some end early.
    pub fn new(setting: &'a Setting, cuts: bool) -> Self {
        let setup = &setting.setup;
        let params = &*setup.params.estimators.likelihood_estimator;
        let states = if cuts { 0..STATES } else { 0..0 };
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
            limits: Cover::new("sides of a limit", if cuts { 2 * least..2 * KINDS } else { 0..0 }),
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
        let place = 1 + self.begun / WHOLE % (STATES - 1);
        let cut = self.cuts && self.begun < WHOLE * STATES && !self.begun.is_multiple_of(WHOLE);
        self.cut = cut.then(|| (place, draw.below(12)));
    }

    /// Draws histograms until one is of its kind.
    fn of_kind(&mut self, kind: u64, draw: &mut Draw) -> Vec<u32> {
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
            let next =
                if kind == CERTAIN { moved(&best, draw) } else { self.nudged(&best, bin, draw) };
            let from = to_limit(&next).filter(|from| from.0 <= distance);
            if let Some(from) = from {
                ((distance, bin), best) = (from, next);
            }
        }
        (best, distance)
    }

    fn histogram(&self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        match kind {
            EXTREME => self.extreme(draw),
            USED_UP | WAITS => self.used_up(14, draw),
            CERTAIN => (0..SHAKES).fold(self.used_up(6, draw), |counts, _| moved(&counts, draw)),
            EMPTY => vec![0; self.params.histogram.bins],
            kind => self.drawn(kind, draw),
        }
    }

    /// A histogram of a scene: an ordinary one, a faint echo, one at either end of the window, or two, of which one is
    /// faint; or a bin of the fit has too many hits.
    fn drawn(&self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        let part = |draw: &mut Draw| draw.below(1000) as f64 / 1000.0;
        let place = match kind {
            AT_END | RISING => 0.99 + 0.06 * part(draw),
            AT_BEGIN => 0.002 + 0.009 * part(draw),
            // Late light is not to come after the window.
            LEAST => 0.85 + 0.1 * part(draw) - self.setup.scenario.laser.delay_ps / self.end_ps(),
            _ => 0.2 + 0.7 * part(draw),
        };
        // What comes back falls with the square of the distance.
        let faint = |place: f64, level: f64, draw: &mut Draw| {
            place * place * level * (1.0 + 0.5 * part(draw))
        };
        let ordinary = 0.03 + 0.9 * part(draw);
        let mut counts = match kind {
            FAINT => self.scene(place, faint(place, 0.0016, draw), 0.3, draw),
            LEAST => self.scene(place, faint(place, 0.0026, draw), 0.55, draw),
            SURE => self.scene(place, faint(place, 0.0016, draw), 0.3, draw),
            TWO | ODD | ANOTHER => self.scene(place, faint(place, 0.02, draw), 0.3, draw),
            AT_BEGIN => self.scene(place, faint(place, 0.2, draw), part(draw), draw),
            _ => self.scene(place, ordinary, part(draw), draw),
        };
        if kind == ODD {
            let peak = (0..counts.len()).max_by_key(|bin| counts[*bin]).unwrap_or(0);
            let odd = (peak + 8).min(counts.len() - 1);
            counts[odd] += counts[odd] / 4 + 100;
        }
        // With two dark blocks the scan expects more ambient light than the fit finds: only the score is low.
        if kind == LEAST {
            let block = counts.len() / BLOCKS;
            counts[block..3 * block].fill(0);
        }
        let other = match kind {
            TWO | ANOTHER => self.scene(1.1 - place, faint(1.1 - place, 0.005, draw), 0.3, draw),
            FALLING => self.scene(1.1 - place, faint(1.1 - place, 0.004, draw), 0.1, draw),
            _ => return counts,
        };
        counts.iter_mut().zip(other).for_each(|(count, other)| *count = (*count + other) / 2);
        counts
    }

    /// End of the window [ps].
    fn end_ps(&self) -> f64 {
        let bins = *self.params.edges.last().unwrap_or(&0) as f64 / 128.0;
        bins * self.setup.scenario.tdc.bin_ps
    }

    /// A histogram of a target at a part of the window.
    fn scene(&self, place: f64, reflectance: f64, irradiance: f64, draw: &mut Draw) -> Vec<u32> {
        let mut scenario = self.setup.scenario.clone();
        scenario.target.distance_m = self.end_ps() * 1.5e-4 * place;
        scenario.target.reflectance = reflectance;
        scenario.ambient.irradiance_w_m2_nm = irradiance;
        let (pulse, mesh) = (self.setup.budget.pulse.clone(), self.setup.mesh.as_deref());
        let budget = Budget::of_scene(&scenario, pulse, mesh);
        let hazard = Hazard::new(&budget.with_dark_rates(&self.setup.dark));
        let chances = BinProbabilities::new(&hazard, &self.setup.bins());
        let counts = chances.draw(self.params.shots, draw.rng());
        let counts = counts.into_iter().map(|count| count as u32).collect();
        if self.params.glass.bins() > 0 { self.behind_glass(counts) } else { counts }
    }

    /// What is left of a histogram behind a cover glass, whose light ends shots first; without fluctuations.
    fn behind_glass(&self, counts: Vec<u32>) -> Vec<u32> {
        let glass = &self.params.glass;
        let light = self.pedestal * glass.light as f64 / 16_384.0 / 131_072.0;
        let (mut waiting, mut left) = (self.params.shots as f64, 1.0);
        let behind = |(bin, count): (usize, u32)| {
            let hazard = light * glass.part(bin) as f64;
            let passed = 1.0 - hazard + 0.5 * hazard * hazard;
            let hits = left * (waiting * (1.0 - passed) + f64::from(count) * passed);
            (waiting, left) = (waiting - f64::from(count), left * passed);
            hits.round() as u32
        };
        counts.into_iter().enumerate().map(behind).collect()
    }

    /// Ambient light, of so many photons a shot over the window, that leaves few shots for the echo, which takes them
    /// all.
    fn used_up(&self, ambient: u32, draw: &mut Draw) -> Vec<u32> {
        let bins = self.params.histogram.bins as u64;
        let echo = bins / 2 + draw.below(bins / 3);
        let mut left = self.params.shots as u32;
        let count = |bin: u64| {
            let now = if bin == echo { left } else { (left * ambient + 128) / bins as u32 };
            left -= now.min(left);
            now
        };
        (0..bins).map(count).collect()
    }

    fn extreme(&self, draw: &mut Draw) -> Vec<u32> {
        let most = self.params.histogram.most_hits();
        let bins = self.params.histogram.bins as u64;
        let full = draw.below(bins);
        let count = |kind: u64, bin: u64, random: u64| match kind {
            0 => 0,
            1 => most,
            2 if bin == 0 => most,
            3 if bin == full => most,
            4 if bin.is_multiple_of(2) => most / 2,
            5 if bin < full => most / bins,
            6 => random & most,
            7 => random % (most / bins + 1),
            _ => 0,
        };
        let kind = self.begun % EXTREMES;
        (0..bins).map(|bin| count(kind, bin, draw.bits()) as u32).collect()
    }

    /// Adds or takes away hits: one in a bin around that one, for a large change of its box's score, or a few in any,
    /// for a small one; one to four times.
    fn nudged(&self, histogram: &[u32], around: u64, draw: &mut Draw) -> Vec<u32> {
        let size = &self.params.histogram;
        let (mut counts, bins, most) =
            (histogram.to_vec(), size.bins as u64, size.most_hits() as u32);
        for _ in 0..=draw.below(4) {
            let near = (around + draw.below(17)).saturating_sub(8).min(bins - 1);
            let (bin, hits) =
                if draw.one_in(2) { (near, 1) } else { (draw.below(bins), draw.below(8) as u32) };
            let count = &mut counts[bin as usize];
            *count =
                if draw.one_in(2) { (*count + hits).min(most) } else { count.saturating_sub(hits) };
        }
        counts
    }

    /// Returns the coverage.
    pub fn coverage(self) -> [Cover; 5] {
        [self.starts, self.resets, self.seen, self.modes, self.limits]
    }
}

/// Moves hits between the last bin that has some, which takes all shots that are left, and one before it.
fn moved(histogram: &[u32], draw: &mut Draw) -> Vec<u32> {
    let mut counts = histogram.to_vec();
    let last = counts.iter().rposition(|&count| count > 0).unwrap_or(0);
    let bin = draw.below(last.max(1) as u64) as usize;
    let [from, to] = if draw.one_in(2) { [last, bin] } else { [bin, last] };
    let hits = counts[from].min(1 + draw.below(4) as u32);
    counts[from] -= hits;
    counts[to] += hits;
    counts
}
