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
use crate::network::Histogram;
use crate::optics::BinProbabilities;
use crate::scenario::QuenchMode;
use crate::scenario::wiring::Wiring;
use crate::sensor::light::{Light, Optics};
use crate::sensor::streams::{Source, stream};
use crate::sim::frames::Frame;
use crate::sim::run::{Observers, Outcome};
use crate::sim::setup::Setup;
use crate::waves::Marks;

use super::many::deliver;
use super::outcomes::ShotOutcomes;

/// The light of a setup and what becomes of its shots, where a frame is one draw. `who` wants to know,
/// for the error.
///
/// # Errors
/// When more than a shot's first avalanche decides what becomes of it (MODE 1, afterpulses, crosstalk from SPADs that
/// are not on the TDC, shaped pulses, a calibration in the firmware, jitter, a chain that is another at each edge,
/// control changes, a stimulus in place of light, a chain too long for the laser rate), or a frame never ends.
pub fn independent_shots<'a>(setup: &'a Setup, who: &str) -> Result<(&'a Optics, ShotOutcomes)> {
    let refusal = |field: &str, why: &str| {
        let expected = format!("{who} draws a frame as a whole: {why}");
        Input::new(format!("scenario {}", setup.name), expected).field(field)
    };
    let firmware = &setup.scenario.firmware;
    for (field, value, held) in [
        ("firmware.rst", firmware.rst, true),
        ("firmware.dsp_rst", firmware.dsp_rst, true),
        ("firmware.dsp_en", firmware.dsp_en, false),
    ] {
        if value == held {
            return Err(refusal(field, "no frame would end").value(value).into());
        }
    }
    if firmware.mode != QuenchMode::EachShot {
        let why = "expected 0: in MODE 1 a shot may have several avalanches";
        return Err(refusal("firmware.mode", why).value(u64::from(firmware.mode)).into());
    }
    let afterpulses = setup.scenario.spad.afterpulse_probability;
    if afterpulses > 0.0 {
        let why = "expected 0: an afterpulse of one shot may be the first avalanche of the next";
        return Err(refusal("spad.afterpulse_probability", why).value(afterpulses).into());
    }
    let spad = &setup.scenario.spad;
    if spad.crosstalk_probability > 0.0 && Wiring::of(spad).has_unwired() {
        let why = "expected 0 with spad.row_outputs: SPADs that are not on the TDC set off those that are";
        let refused = refusal("spad.crosstalk_probability", why);
        return Err(refused.value(spad.crosstalk_probability).into());
    }
    if let Some((field, value)) = spad.shaping().next() {
        let why = "expected 0: what pulses the TDC sees is not worked out for a shaper";
        return Err(refusal(field, why).value(value).into());
    }
    let recalibrated = setup.scenario.tdc.recalibrate_frames;
    if recalibrated > 0 {
        let why = "expected 0: ages are those of the hits of each calibration";
        return Err(refusal("tdc.recalibrate_frames", why).value(recalibrated).into());
    }
    let tdc = &setup.scenario.tdc;
    if tdc.setup_window_ps > 0.0 {
        let why = "expected 0: each edge draws when its registers sample";
        return Err(refusal("tdc.setup_window_ps", why).value(tdc.setup_window_ps).into());
    }
    if let (true, Some(file)) = (setup.disturbance().is_some(), &tdc.conditions) {
        let why = "expected none: the chain changes within a frame";
        return Err(refusal("tdc.conditions", why).value(file).into());
    }
    if !setup.scenario.control.is_empty() {
        return Err(refusal("control", "nothing may change within it").into());
    }
    if setup.scenario.pll.jitter_rms_ps > 0.0 {
        let why = "expected 0: with jitter shots differ";
        let refused = refusal("pll.jitter_rms_ps", why);
        return Err(refused.value(setup.scenario.pll.jitter_rms_ps).into());
    }
    let Light::Optics(optics) = &setup.light else {
        return Err(refusal("stimulus", "it needs the light of the link budget").into());
    };
    let outcomes = ShotOutcomes::new(&setup.params.tdc, setup.laser_period());
    let Some(outcomes) = outcomes else {
        let why = "the chain is so long that a shot reaches into the next one";
        let refused = refusal("tdc.profile", why).value(&setup.scenario.tdc.profile);
        return Err(refused.into());
    };
    Ok((optics, outcomes))
}

/// Draws the frames of a scenario.
#[derive(Clone, Debug)]
pub struct Histograms<'a> {
    setup: &'a Setup,
    /// The kinds of frame, in turn.
    kinds: Vec<Kind>,
    shots: u64,
    frame_cycles: u64,
}

/// Distribution of a lit or of a dark frame.
#[derive(Clone, Debug)]
struct Kind {
    lit: bool,
    codes: BinProbabilities,
    /// Chance that a shot without a code has a hit, and that the last one of a frame does.
    no_code: [f64; 2],
}

impl<'a> Histograms<'a> {
    /// For the frames of `setup`.
    ///
    /// # Errors
    /// When more than a shot's first avalanche decides what becomes of it, or a frame never ends.
    pub fn new(setup: &'a Setup) -> Result<Self> {
        let (optics, outcomes) = independent_shots(setup, "--fidelity histogram")?;
        let firmware = &setup.scenario.firmware;
        let bins = setup.bins();
        let kind = |lit| {
            let hazard = optics.hazard(lit);
            let codes = BinProbabilities::new(hazard, &bins);
            let uncoded = 1.0 - codes.of_code().iter().sum::<f64>();
            let no_code = outcomes.ends().map(|end| {
                let missed = hazard.none_before(end);
                if missed < uncoded { 1.0 - missed / uncoded } else { 0.0 }
            });
            Kind { lit, codes, no_code }
        };
        let dark = setup.has_pairs().then(|| kind(false));
        Ok(Histograms {
            setup,
            kinds: dark.into_iter().chain([kind(firmware.laser_en)]).collect(),
            shots: setup.shots(1),
            frame_cycles: setup.frame_cycles(setup.laser_period()),
        })
    }

    /// Draws a frame.
    pub fn frame(&self, index: u64) -> Frame {
        let mut random = stream(self.setup.scenario.seed, Source::Histogram, index);
        let kind = &self.kinds[index as usize % self.kinds.len()];
        let counts = kind.codes.draw(self.shots, &mut random);
        let coded: u64 = counts.iter().sum();
        let tdc_hits = coded + self.hits_without_code(kind, self.shots - coded, &mut random);
        let histogram: Histogram = counts.into_iter().map(|count| count as u32).collect();
        Frame {
            index,
            laser_en: kind.lit,
            depth: self.setup.depth(&histogram),
            shots: self.shots,
            tdc_hits,
            histogram,
            estimator_cycles: self.setup.params.estimator_cycles(),
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

    /// Draws frames on all threads of the current pool; of `observers`, every frame is shown, in order.
    ///
    /// # Errors
    /// When a sink fails or the run is stopped.
    pub fn many(&self, count: u64, observers: Observers) -> Result<Outcome> {
        let Observers { frames, stop, .. } = observers;
        deliver(0..count, frames, stop, |index| Ok(self.frame(index)))?;
        let cycles = count.saturating_mul(self.frame_cycles + 1);
        Ok(Outcome {
            end: self.setup.end(count).unwrap_or(Time::NEVER),
            cycles,
            shots: self.setup.shots(count),
            marks: Marks::default(),
            notes: Vec::new(),
        })
    }
}
