//! States of a scenario's effects: those that can be separated, and the reasons why the others cannot.

use tofsim::Note;
use tofsim::error::{Error, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::domain;
use tofsim::sim::setup::Setup;

use crate::estimation::EstimatorKind;

use super::configured::estimator;
use super::effect::{Effect, EffectSet};
use super::presence::present;
use super::variant::Variant;

pub use super::presence::EffectState;

/// The state of each effect, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectStates(Vec<(Effect, EffectState)>);

impl EffectStates {
    /// Of a scenario and a kind of estimator: what is there, and can be switched off alone and together with all
    /// others without leaving what the estimator is for.
    ///
    /// # Errors
    /// When the estimator cannot be made for the scenario itself.
    pub fn of(loaded: &Loaded, setup: &Setup, kind: EstimatorKind) -> Result<Self> {
        let states = Effect::ALL.map(|effect| (effect, present(effect, setup, kind)));
        let mut states = EffectStates(states.into());
        let all = states.on_or_left_out();
        let as_is = Variant::new(loaded, all)?;
        estimator(kind, &as_is)?;
        let known: Vec<_> =
            domain_notes(kind, &as_is.setup)?.into_iter().map(|note| note.key).collect();
        // From all on to all off, each in its turn: what the estimator cannot do without stays on.
        let mut left = all.filter(|effect| !effect.joins_shots());
        for (effect, state) in &mut states.0 {
            if *state != EffectState::On {
                continue;
            }
            for rest in [all, left] {
                let variant = Variant::new(loaded, rest.without(*effect))?;
                if let Some(why) = unfit(kind, &variant, &known)? {
                    *state = EffectState::LeftOut(why);
                }
            }
            if *state == EffectState::On {
                left = left.without(*effect);
            }
        }
        Ok(states)
    }

    /// Each effect and its state.
    pub fn iter(&self) -> impl Iterator<Item = &(Effect, EffectState)> {
        self.0.iter()
    }

    /// The effects that are measured.
    pub fn on(&self) -> EffectSet {
        self.filter(|state| *state == EffectState::On)
    }

    /// The effects that are there all the time.
    pub fn left_out(&self) -> EffectSet {
        self.filter(|state| matches!(state, EffectState::LeftOut(_)))
    }

    /// All effects that are there.
    pub fn on_or_left_out(&self) -> EffectSet {
        self.filter(|state| !matches!(state, EffectState::Off(_)))
    }

    fn filter(&self, keep: impl Fn(&EffectState) -> bool) -> EffectSet {
        EffectSet::of(self.0.iter().filter(|(_, state)| keep(state)).map(|(effect, _)| *effect))
    }
}

/// Returns why a variant cannot be evaluated: the estimator cannot be made for it, or is a network that was trained for
/// the scenario but not for the variant.
fn unfit(kind: EstimatorKind, variant: &Variant, known: &[String]) -> Result<Option<String>> {
    match estimator(kind, variant) {
        Err(Error::Input(fault)) => {
            return Ok(Some(format!("it cannot be switched off for {}: {fault}", kind.name())));
        }
        Err(fault) => return Err(fault),
        Ok(_) => {}
    }
    let notes = domain_notes(kind, &variant.setup)?;
    // With a calibration of now the conditions are as strange to the network as before, and the bins are not.
    let is_known = |key: &String| known.contains(key) || key.starts_with("tdc.calibrated_at");
    let new = notes.into_iter().find(|note| !is_known(&note.key));
    Ok(new.map(|note| {
        format!(
            "it cannot be switched off, because the network was trained for {} = {} only",
            note.key, note.expected
        )
    }))
}

/// Returns notes on a scenario outside the network's training domain; none for other estimators.
pub fn domain_notes(kind: EstimatorKind, setup: &Setup) -> Result<Vec<Note>> {
    if kind.is_network() {
        domain::notes(&setup.network, &setup.scenario, &[])
    } else {
        Ok(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;

    fn states(name: &str, keys: &[&str], kind: EstimatorKind) -> EffectStates {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        let loaded = scenario::load(name, &keys).unwrap();
        let setup = Setup::of_counts(loaded.clone()).unwrap();
        EffectStates::of(&loaded, &setup, kind).unwrap()
    }

    fn state(of: &EffectStates, effect: Effect) -> EffectState {
        of.iter().find(|(one, _)| *one == effect).unwrap().1.clone()
    }

    #[test]
    fn what_the_scenario_does_not_have_is_off_with_the_key_that_says_so() {
        let states = states("kc705", &[], EstimatorKind::Likelihood);
        for (effect, why) in [
            (Effect::PulseTail, "laser.pulse_tail_ps = 0"),
            (Effect::Afterpulses, "spad.afterpulse_probability = 0"),
            (Effect::DeadTime, "firmware.mode = 0"),
            (Effect::PllJitter, "pll.jitter_rms_ps = 0"),
            (Effect::UnevenTaps, "all taps are equal"),
            (Effect::Calibration, "tdc.calibration = true"),
            (Effect::Table, "only the network's"),
        ] {
            let EffectState::Off(found) = state(&states, effect) else { panic!("{effect:?}") };
            assert!(found.starts_with(why), "{found}");
        }
        for effect in [Effect::ShotNoise, Effect::PileUp, Effect::PulseWidth, Effect::Taps] {
            assert_eq!(state(&states, effect), EffectState::On, "{effect:?}");
        }
    }

    #[test]
    fn a_network_keeps_what_it_was_trained_with() {
        let states_of = |keys| states("kc705", keys, EstimatorKind::Network);
        let own = states_of(&[]);
        for effect in [Effect::PileUp, Effect::PulseWidth, Effect::Taps] {
            assert!(matches!(state(&own, effect), EffectState::LeftOut(_)), "{effect:?}");
        }
        for effect in [Effect::Ambient, Effect::FixedPoint, Effect::Table] {
            assert_eq!(state(&own, effect), EffectState::On, "{effect:?}");
        }
        // It was not trained for that chain in any case, so that all of it can be told apart.
        let other = states_of(&["tdc.profile=kintex7"]);
        assert_eq!(state(&other, Effect::Taps), EffectState::On);
        assert_eq!(state(&other, Effect::UnevenTaps), EffectState::On);
    }

    #[test]
    fn bins_of_whole_taps_have_no_width_of_taps() {
        let ideal = states("kc705", &["tdc.profile=ideal"], EstimatorKind::Likelihood);
        assert_eq!(
            state(&ideal, Effect::Taps),
            EffectState::Off("bins begin where taps do".to_owned())
        );
    }
}
