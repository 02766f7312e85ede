//! Whether a scenario and an estimator have an effect.

use tofsim::kernel::Time;
use tofsim::optics::Bins;
use tofsim::scenario::{QuenchMode, TdcCalibration};
use tofsim::sim::setup::Setup;

use crate::estimation::EstimatorKind;

use super::effect::Effect;
use super::variant::{evened, is_even, shortest_ps};

/// What can be said of an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectState {
    /// The effect is on, and is measured.
    On,
    /// The scenario or the estimator does not have it: why.
    Off(String),
    /// It is there all the time, because it cannot be told from the rest: why.
    LeftOut(String),
}

/// Whether a scenario and an estimator have an effect at all, as far as it can be told.
pub fn present(effect: Effect, setup: &Setup, kind: EstimatorKind) -> EffectState {
    let scenario = &setup.scenario;
    let (laser, spad) = (&scenario.laser, &scenario.spad);
    let left_out = |why: &str| EffectState::LeftOut(why.to_owned());
    let above_zero = |key: &str, value: f64| match value > 0.0 {
        true => EffectState::On,
        false => EffectState::Off(format!("{key} = 0")),
    };
    let unless = |is_off: bool, why: &str| match is_off {
        true => EffectState::Off(why.to_owned()),
        false => EffectState::On,
    };
    match effect {
        Effect::ShotNoise => EffectState::On,
        Effect::PileUp if kind.is_network() => left_out(
            "the network was trained on histograms with pile-up, and cannot be told of others",
        ),
        Effect::PileUp => EffectState::On,
        Effect::Ambient => {
            above_zero("ambient.irradiance_w_m2_nm", setup.budget.ambient_light_hz())
        }
        Effect::DarkCounts => above_zero("spad.dark_rate_hz", setup.budget.dark_rate_hz),
        Effect::PulseWidth => {
            let is_short =
                laser.pulse_file.is_none() && laser.pulse_sigma_ps <= shortest_ps(scenario);
            unless(is_short, "the pulse is no longer than half a bin")
        }
        Effect::PulseTail if laser.pulse_file.is_some() => {
            EffectState::Off("laser.pulse_file has the whole pulse".to_owned())
        }
        Effect::PulseTail => above_zero("laser.pulse_tail_ps", laser.pulse_tail_ps),
        Effect::LaserTiming => above_zero("laser.timing_jitter_ps", laser.timing_jitter_ps),
        Effect::LaserEnergy => above_zero("laser.energy_jitter", laser.energy_jitter),
        Effect::Afterpulses => {
            above_zero("spad.afterpulse_probability", spad.afterpulse_probability)
        }
        Effect::DeadTime => {
            let is_armed = scenario.firmware.mode == QuenchMode::EachShot;
            unless(is_armed, "firmware.mode = 0: a reset arms the diode for each shot")
        }
        Effect::Crosstalk if spad.crosstalk_probability == 0.0 => {
            EffectState::Off("spad.crosstalk_probability = 0".to_owned())
        }
        Effect::Crosstalk => left_out(
            "a neighbour fires at once, within the pulse of the diode that sets it off, and tdc_stop is the OR of both",
        ),
        Effect::PllJitter => above_zero("pll.jitter_rms_ps", scenario.pll.jitter_rms_ps),
        Effect::Taps => {
            let exact = Bins::without_taps(&setup.params.tdc);
            let is_same = are_same(&Bins::of_tdc(&evened(setup, false)), &exact);
            unless(is_same, "bins begin where taps do")
        }
        Effect::UnevenTaps => unless(is_even(&setup.params.tdc), "all taps are alike"),
        Effect::Calibration => {
            let is_true = scenario.tdc.calibration == TdcCalibration::True;
            unless(is_true, "tdc.calibration = true: the ROM has the chain's own delays")
        }
        Effect::BinWidth => {
            left_out("bins are what the estimator is given; the bound without them stands above")
        }
        Effect::Drift => unless(!setup.has_drifted(), "the TDC was calibrated as it is now"),
        Effect::FixedPoint => match kind {
            EstimatorKind::Network if setup.network.float.is_none() => {
                left_out("the network's file has no weights before rounding")
            }
            EstimatorKind::Network
            | EstimatorKind::Centroid
            | EstimatorKind::LikelihoodEstimator => EffectState::On,
            _ => EffectState::Off("the estimator is in double precision".to_owned()),
        },
        Effect::Table => unless(kind != EstimatorKind::Network, "only the network's words have it"),
    }
}

/// Whether all bins begin at the same times, to the femtosecond by which taps begin late.
fn are_same(one: &Bins, other: &Bins) -> bool {
    let near = |a: Time, b: Time| a.fs().abs_diff(b.fs()) <= 1;
    one.spans().len() == other.spans().len()
        && one
            .spans()
            .iter()
            .zip(other.spans())
            .all(|(a, b)| a.code == b.code && near(a.from, b.from) && near(a.until, b.until))
}
