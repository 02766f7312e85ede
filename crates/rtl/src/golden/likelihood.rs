//! Estimations of the likelihood estimator one after the other, for it and for each of its blocks.
//!
//! The histograms are drawn from scenes of the scenario's instrument, near and far, bright and dark, and between
//! them stand extreme ones: empty, full, all hits in one bin, every other bin full, random. Now and then an
//! estimation is started while one is busy, or a reset cuts it short, in each state in turn.

use tofsim::error::{Input, Result};
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator, State};
use tofsim::kernel::U;
use tofsim::optics::{BinProbabilities, Budget, Hazard};
use tofsim::sim::setup::Setup;

use super::cover::Cover;
use super::draw::Draw;
use super::setting::Setting;
use super::spec::FIRST_RESET;

/// States of the estimator.
const STATES: u64 = State::End as u64 + 1;
/// Every so many estimations is a whole one.
const WHOLE: u64 = 2;
/// Kinds of extreme histograms.
const EXTREMES: u64 = 8;

/// Estimations under way.
pub struct Estimations<'a> {
    setup: &'a Setup,
    params: &'a Params,
    histogram: Vec<u32>,
    begun: u64,
    /// State in which this one is cut short, and how many cycles before it is.
    cut: Option<(u64, u64)>,
    cuts: bool,
    line: usize,
    over: bool,
    starts: Cover,
    resets: Cover,
    seen: Cover,
}

impl<'a> Estimations<'a> {
    /// Of the setting's instrument; with `cuts` some end early.
    ///
    /// # Errors
    /// When the estimator's model does not hold for the instrument.
    pub fn new(setting: &'a Setting, cuts: bool) -> Result<Self> {
        let setup = &setting.setup;
        let Some(params) = setup.params.likelihood() else {
            let shots = setup.params.frame_ctrl.shots_per_frame.into();
            let fault = setup.likelihood(shots).err();
            return Err(fault
                .unwrap_or_else(|| Input::new("likelihood_estimator", "no shots"))
                .into());
        };
        let states = if cuts { 0..STATES } else { 0..0 };
        Ok(Estimations {
            setup,
            params,
            histogram: vec![0; params.histogram.bins],
            begun: 0,
            cut: None,
            cuts,
            line: 0,
            over: false,
            starts: Cover::new("start in state", states.clone()),
            resets: Cover::new("reset in state but idle", states.skip(1)),
            seen: Cover::new("depths without and with a status", if cuts { 0..2 } else { 0..0 }),
        })
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
        }
        let idle = block.state() == State::Idle;
        let algo_start = draw.one_in(if idle { 3 } else { 64 });
        self.starts.see_if(algo_start && !rst, state);
        self.resets.see_if(rst, state);
        if rst {
            self.cut = None;
        } else if algo_start && idle {
            self.begin(draw);
        }
        let memory = &block.likelihood_memory.registers;
        let word = if memory.read_en { self.histogram[memory.read_addr.index()] } else { 0 };
        In { rst, algo_start, count: U::new(word.into()) }
    }

    /// Whether these lines and all that follow are drawn for one block alone: from the middle of so many on, once
    /// the estimator is idle. A few histograms reach few of the limits that its words have.
    pub fn over(&mut self, block: &LikelihoodEstimator, lines: usize) -> bool {
        self.over |= self.line >= lines / 2 && block.state() == State::Idle;
        self.over
    }

    /// Another histogram, and perhaps a state in which its estimation is cut short.
    fn begin(&mut self, draw: &mut Draw) {
        self.begun += 1;
        self.histogram = match self.begun % 3 {
            0 => self.extreme(draw),
            _ => self.drawn(draw),
        };
        let place = 1 + self.begun / WHOLE % (STATES - 1);
        let cut = self.cuts && !self.begun.is_multiple_of(WHOLE);
        self.cut = cut.then(|| (place, draw.below(12)));
    }

    fn drawn(&self, draw: &mut Draw) -> Vec<u32> {
        let mut scenario = self.setup.scenario.clone();
        let part = |draw: &mut Draw| draw.below(1000) as f64 / 1000.0;
        let end_ps = *self.params.edges.last().unwrap_or(&0) as f64 / 128.0 * scenario.tdc.bin_ps;
        scenario.target.distance_m = end_ps * 1.5e-4 * (0.04 + 0.9 * part(draw));
        scenario.target.reflectance = 0.03 + 0.9 * part(draw);
        scenario.ambient.irradiance_w_m2_nm = part(draw);
        let hazard = Hazard::new(&Budget::new(&scenario));
        let chances = BinProbabilities::new(&hazard, &self.setup.bins());
        let counts = chances.draw(self.params.shots, draw.rng());
        counts.into_iter().map(|count| count as u32).collect()
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
        let kind = self.begun / 3 % EXTREMES;
        (0..bins).map(|bin| count(kind, bin, draw.bits()) as u32).collect()
    }

    /// What has been reached.
    pub fn coverage(self) -> [Cover; 3] {
        [self.starts, self.resets, self.seen]
    }
}
