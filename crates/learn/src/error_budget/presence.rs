//! Whether a scenario and an estimator have an effect.

use tofsim::kernel::Time;
use tofsim::optics::Bins;
use tofsim::scenario::TdcCalibration;
use tofsim::scenario::effects::Effect as ScenarioEffect;
use tofsim::sim::setup::Setup;

use crate::estimation::EstimatorKind;

use super::effect::Effect;
use super::variant::{evened, is_even, shortest_ps};

/// The state of an effect in a budget.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectState {
    /// The effect is on, and is measured.
    On,
    /// The scenario or the estimator does not have it, with the reason.
    Off(String),
    /// It is on in every variant, because it cannot be separated, with the reason.
    LeftOut(String),
}

/// Returns whether a scenario and an estimator have an effect at all.
pub fn present(effect: Effect, setup: &Setup, kind: EstimatorKind) -> EffectState {
    let scenario = &setup.scenario;
    let left_out = |why: &str| EffectState::LeftOut(why.to_owned());
    let above_zero = |key: &str, value: f64| {
        if value > 0.0 { EffectState::On } else { EffectState::Off(format!("{key} = 0")) }
    };
    let unless = |is_off: bool, why: &str| {
        if is_off { EffectState::Off(why.to_owned()) } else { EffectState::On }
    };
    if let Some(keys @ [key, ..]) = effect.of_scenario().map(ScenarioEffect::keys)
        && keys.iter().all(|key| key.is_usual(scenario))
    {
        let why = match effect {
            Effect::DeadTime => ": a reset arms the diode for each shot",
            _ => "",
        };
        return EffectState::Off(format!("{} = {}{why}", key.name, key.usual()));
    }
    match effect {
        Effect::PileUp if kind.is_network() => left_out(
            "the network was trained on histograms with pile-up, and cannot be configured for others",
        ),
        Effect::Ambient => {
            above_zero("ambient.irradiance_w_m2_nm", setup.budget.ambient_light_hz())
        }
        Effect::DarkCounts => above_zero("spad.dark_rate_hz", setup.budget.dark_rate_hz),
        Effect::PulseWidth => {
            let is_short = ScenarioEffect::MeasuredPulse.occurrence(scenario).is_none()
                && scenario.laser.pulse_sigma_ps <= shortest_ps(scenario);
            unless(is_short, "the pulse is no longer than half a bin")
        }
        Effect::Crosstalk => left_out(
            "a neighbour fires at once, within the pulse of the diode that sets it off, and tdc_stop is the OR of both",
        ),
        Effect::Taps => {
            let exact = Bins::without_taps(&setup.params.tdc);
            let is_same = are_same(&Bins::of_tdc(&evened(setup, false)), &exact);
            unless(is_same, "bins begin where taps do")
        }
        Effect::UnevenTaps => unless(is_even(&setup.params.tdc), "all taps are equal"),
        Effect::Calibration => {
            let is_true = scenario.tdc.calibration == TdcCalibration::True;
            unless(is_true, "tdc.calibration = true: the ROM has the chain's own delays")
        }
        Effect::BinWidth => {
            left_out("estimators work on bins; the bound without bins is printed above")
        }
        Effect::Drift => unless(!setup.has_drifted(), "the TDC was calibrated as it is now"),
        Effect::FixedPoint => match kind {
            EstimatorKind::Network if !setup.network.float.is_known() => {
                left_out("the network's file has no weights before rounding")
            }
            EstimatorKind::Network
            | EstimatorKind::Centroid
            | EstimatorKind::LikelihoodEstimator => EffectState::On,
            _ if kind.is_in_firmware() => left_out("the estimator has no twin in double precision"),
            _ => EffectState::Off("the estimator is in double precision".to_owned()),
        },
        Effect::Table => unless(kind != EstimatorKind::Network, "only the network's words have it"),
        _ => EffectState::On,
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
