//! The table of effects.

use crate::scenario::wiring::Wiring;
use crate::scenario::{QuenchMode, Scenario};

use super::key::{Key, key};
use super::method::Method::{
    self, Centroid, CramerRaoBound, FastForward, HistogramDraw, IndependentShots, Likelihood,
    LikelihoodEstimator, Matched, Peak, SecondOpinion, SeparateFrames, TwoEchoes, VerilogBench,
};

/// Estimators that model how the light of a frame becomes a histogram.
const MODELS: &[Method] = &[Likelihood, TwoEchoes, LikelihoodEstimator, Matched];
/// Those whose model knows nothing of jitter and of MODE 1.
const MODE_0_MODELS: &[Method] = &[TwoEchoes, LikelihoodEstimator, Matched];
/// Estimators that look for the place of the echo only.
const SEARCHES: &[Method] = &[Centroid, Peak];
/// Jitter that moves a search by a tenth of a millimetre [ps].
const SMALL_JITTER: f64 = 20.0;
/// Afterpulses that move a search by less than a tenth of a millimetre: they come evenly, as ambient light does [1].
const FEW_AFTERPULSES: f64 = 0.01;
/// A tail that is negligible beside the thesis's pulse: 2 % of its standard deviation [ps].
const SHORT_TAIL: f64 = 0.02 * 137.0;

/// A row of the table.
pub(super) struct Row {
    /// Description of the effect in a sentence.
    pub meaning: &'static str,
    /// The keys that switch the effect on.
    pub keys: &'static [Key],
    /// Additional condition for the presence of the effect.
    pub when: fn(&Scenario) -> bool,
    /// The methods that it invalidates.
    pub breaks: &'static [&'static [Method]],
    /// The methods that only more of it invalidates, and the largest value that does not [the key's unit].
    pub above: (f64, &'static [Method]),
    /// The methods that it leaves valid in a scenario that has what they need.
    pub spares: fn(&Scenario) -> &'static [Method],
    /// Why, as a clause.
    pub why: &'static str,
    /// Settings that show the effect.
    pub example: &'static [&'static str],
}

impl Row {
    const EMPTY: Row = Row {
        meaning: "",
        keys: &[],
        when: |_| true,
        breaks: &[],
        above: (0.0, &[]),
        spares: |_| &[],
        why: "",
        example: &[],
    };
}

/// Declares the effects, their list and their rows.
macro_rules! effects {
    ($(
        #[doc = $meaning:literal]
        $effect:ident {
            keys: [$($key:expr),* $(,)?],
            $(when: $when:expr,)?
            breaks: [$($breaks:expr),* $(,)?],
            $(above: $above:expr,)?
            $(spares: $spares:expr,)?
            why: $why:literal,
            example: [$($example:literal),* $(,)?],
        }
    )*) => {
        /// An effect that invalidates a method of simulation or estimation.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Effect {
            $(#[doc = $meaning] $effect,)*
        }

        impl Effect {
            /// All effects, in the order in which they are looked for.
            pub const ALL: [Effect; [$(stringify!($effect)),*].len()] = [$(Effect::$effect),*];

            pub(super) fn row(self) -> &'static Row {
                &ROWS[self as usize]
            }
        }

        static ROWS: [Row; Effect::ALL.len()] = [$(Row {
            meaning: $meaning,
            keys: &[$($key),*],
            $(when: $when,)?
            breaks: &[$($breaks),*],
            $(above: $above,)?
            $(spares: $spares,)?
            why: $why,
            example: &[$($example),*],
            ..Row::EMPTY
        }),*];
    };
}

fn is_free_running(scenario: &Scenario) -> bool {
    scenario.firmware.mode == QuenchMode::FreeRunning
}

/// Returns the methods that have the cover window's light in their model, if its template is known.
fn with_template(scenario: &Scenario) -> &'static [Method] {
    match scenario.estimator.glass_file {
        Some(_) => {
            &[CramerRaoBound, Likelihood, TwoEchoes, LikelihoodEstimator, SecondOpinion, Matched]
        }
        None => &[],
    }
}

/// Returns the methods that find a second target.
fn with_two_targets(scenario: &Scenario) -> &'static [Method] {
    if scenario.estimator.targets > 1 { &[LikelihoodEstimator, SecondOpinion] } else { &[] }
}

fn has_cover(scenario: &Scenario) -> bool {
    scenario.cover.is_there()
}

fn has_unwired_outputs(scenario: &Scenario) -> bool {
    Wiring::of(&scenario.spad).has_unwired() || scenario.array.columns > 1
}

effects! {
    /// A control signal keeps frames from ending.
    HeldFrame {
        keys: [key!(firmware.rst), key!(firmware.dsp_rst), key!(firmware.dsp_en)],
        breaks: [&[HistogramDraw]],
        why: "no frame would end",
        example: ["firmware.dsp_en=false"],
    }
    /// The SPAD is armed again after its dead time, and not by a reset before each shot (MODE 1).
    FreeRunning {
        keys: [key!(firmware.mode)],
        breaks: [&[SeparateFrames, IndependentShots], MODE_0_MODELS, SEARCHES],
        why: "in MODE 1 a shot may have several avalanches, and may begin with a dead SPAD or a pulse in the chain",
        example: ["firmware.mode=1"],
    }
    /// Several SPADs drive the TDC in MODE 1.
    SharedTdc {
        keys: [key!(spad.on_tdc)],
        when: is_free_running,
        breaks: [&[Likelihood, TwoEchoes]],
        why: "in MODE 1 the SPADs on the TDC come back one by one",
        example: ["firmware.mode=1", "spad.on_tdc=4"],
    }
    /// A photon within the dead time of MODE 1 starts it again.
    PassiveRecharge {
        keys: [key!(spad.dead_time_kind)],
        when: is_free_running,
        breaks: [&[Likelihood]],
        why: "the dead time differs from avalanche to avalanche",
        example: ["firmware.mode=1", "spad.dead_time_kind=paralysable"],
    }
    /// Control signals change during the run.
    ControlChanges {
        keys: [key!(control)],
        breaks: [&[SeparateFrames, IndependentShots], MODELS],
        why: "the shots of a frame differ",
        example: ["control=[{at_us=12.3,laser_en=false}]"],
    }
    /// Clock edges jitter.
    ClockJitter {
        keys: [key!(pll.jitter_rms_ps)],
        breaks: [&[HistogramDraw, VerilogBench, LikelihoodEstimator, Matched]],
        above: (SMALL_JITTER, SEARCHES),
        why: "jitter blurs the histogram after pile-up has shaped it",
        example: ["pll.jitter_rms_ps=95"],
    }
    /// Temperature or supply change during the run, and the chain's delays with them.
    ChangingConditions {
        keys: [key!(tdc.conditions)],
        breaks: [&[FastForward, SeparateFrames, IndependentShots, VerilogBench, SecondOpinion]],
        why: "the delays of the chain change during the run",
        example: ["tdc.conditions=conditions.csv"],
    }
    /// Registers of the chain sample within a set-up window about the edge.
    Metastability {
        keys: [key!(tdc.setup_window_ps)],
        breaks: [&[FastForward, IndependentShots, VerilogBench], MODELS],
        why: "each edge draws when its registers sample, which blurs the borders of bins",
        example: ["tdc.setup_window_ps=40"],
    }
    /// Pulses leave the laser early or late.
    LaserTiming {
        keys: [key!(laser.timing_jitter_ps)],
        breaks: [&[CramerRaoBound], MODELS],
        above: (SMALL_JITTER, SEARCHES),
        why: "the delay of the laser differs from shot to shot",
        example: ["laser.timing_jitter_ps=200"],
    }
    /// Pulses differ in energy.
    LaserEnergy {
        keys: [key!(laser.energy_jitter)],
        breaks: [&[CramerRaoBound], MODELS],
        why: "the pulse energy differs from shot to shot",
        example: ["laser.energy_jitter=0.8"],
    }
    /// The target is not the plain rectangle of eq. 3.23, or a pixel sees a rectangle of it.
    Target {
        keys: [
            key!(target.shape),
            key!(target.tilt_deg),
            key!(target.yaw_deg),
            key!(target.offset_x_m),
            key!(target.offset_y_m),
            key!(target.retro_side_m),
            key!(target.extended),
            key!(array.field_of_view_deg),
            key!(array.rows),
            key!(array.columns),
        ],
        breaks: [&[CramerRaoBound], MODELS, SEARCHES],
        why: "the light of a shot is not one echo of the laser's pulse from the axis",
        example: ["target.shape=step", "target.second_distance_m=0.33"],
    }
    /// The air scatters light.
    Air {
        keys: [key!(atmosphere.visibility_m), key!(atmosphere.rain_mm_h)],
        breaks: [&[CramerRaoBound], MODELS, SEARCHES],
        why: "the light of a shot is not one echo of the laser's pulse: the air sends some back",
        example: ["atmosphere.visibility_m=2"],
    }
    /// A second surface shares the field of view with the target.
    SecondTarget {
        keys: [key!(target.second_share)],
        breaks: [&[Likelihood, LikelihoodEstimator, Matched], SEARCHES],
        spares: with_two_targets,
        why: "the light of a shot is two echoes of the laser's pulse",
        example: ["target.second_share=0.5", "target.second_distance_m=0.45", "target.second_reflectance=0.9"],
    }
    /// A cover window sends a part of the pulse back to the detector.
    Cover {
        keys: [key!(cover.fraction), key!(cover.fraction_file), key!(cover.dirt_per_h)],
        when: has_cover,
        breaks: [&[CramerRaoBound], MODELS, SEARCHES],
        spares: with_template,
        why: "the light of a shot is not one echo of the laser's pulse: the cover window sends some back, which piles up before the echo",
        example: ["cover.fraction=1e-4", "cover.delay_ps=600", "cover.smear_fraction=0.3"],
    }
    /// The pulse is a measured one.
    MeasuredPulse {
        keys: [key!(laser.pulse_file)],
        breaks: [&[Peak]],
        why: "K_d and B_d of eq. 5.2 are fitted to the thesis's pulse",
        example: ["laser.pulse_file=pulse.csv"],
    }
    /// The pulse has an exponential tail.
    PulseTail {
        keys: [key!(laser.pulse_tail_ps)],
        breaks: [],
        above: (SHORT_TAIL, &[Peak]),
        why: "K_d and B_d of eq. 5.2 are fitted to the thesis's pulse",
        example: ["laser.pulse_tail_ps=150"],
    }
    /// Light leaves some time after the laser edge.
    LaserDelay {
        keys: [key!(laser.delay_ps)],
        breaks: [&[Peak]],
        why: "times count from the laser edge, so that the delay is taken for distance",
        example: ["laser.delay_ps=600"],
    }
    /// Carriers in traps fire a SPAD again.
    Afterpulses {
        keys: [key!(spad.afterpulse_probability)],
        breaks: [&[SeparateFrames, IndependentShots, CramerRaoBound], MODELS],
        above: (FEW_AFTERPULSES, SEARCHES),
        why: "an afterpulse of one shot may be the first hit of the next",
        example: ["spad.afterpulse_probability=0.6", "spad.afterpulse_ns=9000"],
    }
    /// SPADs that are not on the TDC set off those that are.
    Crosstalk {
        keys: [key!(spad.crosstalk_probability)],
        when: has_unwired_outputs,
        breaks: [&[IndependentShots], MODELS],
        why: "SPADs that are not on the TDC set off those that are (spad.row_outputs, array.columns)",
        example: ["spad.crosstalk_probability=0.4", "spad.row_outputs=30"],
    }
    /// A monostable or a recovery time shapes the pulses on `tdc_stop`.
    PulseShaping {
        keys: [key!(spad.pulse_ns), key!(spad.pulse_gap_ns)],
        breaks: [&[FastForward, SeparateFrames, IndependentShots], MODELS, SEARCHES],
        why: "the TDC misses avalanches within a pulse or gap, and a pulse may outlast its shot",
        example: ["spad.pulse_ns=30", "spad.pulse_gap_ns=6000"],
    }
    /// The firmware calibrates its TDC between frames.
    Recalibration {
        keys: [key!(tdc.recalibrate_frames)],
        breaks: [&[FastForward, SeparateFrames, IndependentShots], MODELS],
        why: "the ages in the decoder are those of the last calibration, with the errors that its hits leave",
        example: ["tdc.recalibrate_frames=1", "tdc.calibration_hits_log2=10"],
    }
    /// Photons or codes of a list stand in for light.
    ListedShots {
        keys: [key!(stimulus.photons), key!(stimulus.codes)],
        breaks: [&[SeparateFrames, IndependentShots]],
        why: "its shots are those of a list, not of the link budget",
        example: ["stimulus.photons=photons.csv"],
    }
    /// A histogram of a file stands in for shots.
    ListedHistogram {
        keys: [key!(stimulus.histogram)],
        breaks: [&[IndependentShots]],
        why: "its histogram is that of a file, not of the link budget",
        example: ["stimulus.histogram=histogram.csv"],
    }
}
