//! A frame in one draw: its histogram as a multinomial number, and the estimate of that.
//!
//! Exact in distribution where a shot is its first avalanche alone, and shots are independent. The
//! codes' probabilities are those of the closed form ([`crate::optics::closed_form`]); they are worked
//! out once, and a frame is a binomial draw for each bin and one more at most.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Binomial, Distribution};

use crate::error::{Input, Result};
use crate::kernel::Time;
use crate::optics::BinProbabilities;
use crate::scenario::effects::Method;
use crate::sensor::light::{Light, Optics};
use crate::sensor::streams::{Source, stream};
use crate::sim::frames::Frame;
use crate::sim::run::{Observers, Outcome};
use crate::sim::setup::Setup;
use crate::waves::Marks;

use super::many::deliver;
use super::multinomial::Multinomial;
use super::outcomes::ShotOutcomes;

/// Returns the light of a setup and the outcomes of its shots, where a frame is one draw; `user` names what needs them
/// in the error.
///
/// # Errors
/// When an effect of the scenario invalidates [`Method::HistogramDraw`], or the chain is too long for the laser rate.
pub fn independent_shots<'a>(setup: &'a Setup, user: &str) -> Result<(&'a Optics, ShotOutcomes)> {
    setup.require(Method::HistogramDraw, user)?;
    let refused = |field: &str, why: &str| {
        let expected = format!("expected another for {user}: {why}");
        Input::new(format!("scenario {}", setup.name), expected).field(field)
    };
    let Light::Optics(optics) = &setup.light else {
        return Err(refused("stimulus", "it needs the light of the link budget").into());
    };
    let Some(outcomes) = ShotOutcomes::new(&setup.params.tdc, setup.laser_period()) else {
        let why = "the chain is so long that a shot reaches into the next one";
        let fault = refused("tdc.profile", why).value(&setup.scenario.tdc.profile);
        return Err(fault.into());
    };
    Ok((optics, outcomes))
}

/// Draws the frames of a scenario.
#[derive(Clone, Debug)]
pub struct Histograms<'a> {
    setup: &'a Setup,
    frames: FrameDistribution,
}

/// Distribution of a setup's frames.
#[derive(Clone, Debug)]
pub struct FrameDistribution {
    /// The kinds of frame, in turn.
    kinds: Vec<Kind>,
    seed: u64,
    shots: u64,
    frame_cycles: u64,
}

/// Distribution of a lit or of a dark frame.
#[derive(Clone, Debug)]
struct Kind {
    lit: bool,
    codes: Multinomial,
    /// Chance that a shot without a code has a hit, and that the last one of a frame does.
    no_code: [f64; 2],
}

impl FrameDistribution {
    /// Computes the distribution of the frames of `setup`.
    ///
    /// # Errors
    /// When more than a shot's first avalanche decides what becomes of it, or a frame never ends.
    pub fn new(setup: &Setup) -> Result<Self> {
        let (optics, outcomes) = independent_shots(setup, "--fidelity histogram")?;
        let firmware = &setup.scenario.firmware;
        let (bins, shots) = (setup.bins(), setup.shots(1));
        let kind = |lit| {
            let hazard = optics.hazard(lit);
            let codes = BinProbabilities::new(hazard, &bins);
            let uncoded = 1.0 - codes.of_code().iter().sum::<f64>();
            let no_code = outcomes.ends().map(|end| {
                let missed = hazard.none_before(end);
                if missed < uncoded { 1.0 - missed / uncoded } else { 0.0 }
            });
            Kind { lit, codes: Multinomial::new(&codes, shots), no_code }
        };
        let dark = setup.has_pairs().then(|| kind(false));
        Ok(FrameDistribution {
            seed: setup.seed(),
            kinds: dark.into_iter().chain([kind(firmware.laser_en)]).collect(),
            shots,
            frame_cycles: setup.frame_cycles(setup.laser_period()),
        })
    }

    /// Draws a frame, whose firmware is that of `setup`.
    pub fn frame(&self, setup: &Setup, index: u64) -> Frame {
        let mut random = stream(self.seed, Source::Histogram, index);
        let kind = &self.kinds[index as usize % self.kinds.len()];
        let (histogram, uncoded) = kind.codes.draw(&mut random);
        let tdc_hits = self.shots - uncoded + self.hits_without_code(kind, uncoded, &mut random);
        Frame {
            index,
            laser_en: kind.lit,
            estimator: setup.params.estimator,
            words: setup.estimate_words(&histogram),
            shots: self.shots,
            tdc_hits,
            histogram,
            estimator_cycles: setup.params.estimator_cycles(),
            frame_cycles: self.frame_cycles,
        }
    }

    /// Hits among so many shots without a code, one of which may be the frame's last.
    fn hits_without_code(&self, kind: &Kind, shots: u64, random: &mut ChaCha8Rng) -> u64 {
        let last = u64::from(random.random_range(0..self.shots) < shots);
        let draw = |shots, chance| Binomial::new(shots, chance).ok();
        let drawn = [draw(shots - last, kind.no_code[0]), draw(last, kind.no_code[1])];
        drawn.into_iter().flatten().map(|draw| draw.sample(random)).sum()
    }
}

impl<'a> Histograms<'a> {
    /// For the frames of `setup`.
    ///
    /// # Errors
    /// When more than a shot's first avalanche decides what becomes of it, or a frame never ends.
    pub fn new(setup: &'a Setup) -> Result<Self> {
        Ok(Histograms { setup, frames: FrameDistribution::new(setup)? })
    }

    /// Draws a frame.
    pub fn frame(&self, index: u64) -> Frame {
        self.frames.frame(self.setup, index)
    }

    /// Draws frames on all threads of the current pool; of `observers`, every frame is shown, in order.
    ///
    /// # Errors
    /// When a sink fails or the run is stopped.
    pub fn many(&self, count: u64, observers: Observers) -> Result<Outcome> {
        let Observers { frames, stop, .. } = observers;
        deliver(0..count, frames, stop, |index| Ok(self.frame(index)))?;
        let cycles = count.saturating_mul(self.frames.frame_cycles + 1);
        Ok(Outcome {
            end: self.setup.end(count).unwrap_or(Time::NEVER),
            cycles,
            shots: self.setup.shots(count),
            marks: Marks::default(),
            notes: Vec::new(),
        })
    }
}
