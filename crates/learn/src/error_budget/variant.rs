//! A scenario with some of its effects off.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::tdc;
use tofsim::firmware::tdc_decoder::Calibration;
use tofsim::kernel::U;
use tofsim::optics::{Bins, Hazard};
use tofsim::scenario::{Loaded, Scenario, TdcCalibration};
use tofsim::sim::setup::Setup;

use crate::estimation::Acquisition;
use crate::estimation::acquisition::MOST_SHOTS;

use super::effect::{Effect, EffectSet};
use super::expected::per_shot;
use super::histograms::Histograms;

/// Standard deviation of the pulse without a width: the shortest that lights more than one bin, so that its position
/// within a bin is known, and the shortest that `likelihood_estimator` supports [bins].
pub const SHORTEST_BINS: f64 = 0.5;

/// A scenario with some effects on and the others off.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Effects that are on.
    pub effects: EffectSet,
    /// The scenario, ready to run.
    pub setup: Setup,
    /// Avalanche times of each code.
    pub bins: Bins,
    /// Avalanche times that estimators assume: those of the chain as it was calibrated.
    pub assumed_bins: Bins,
    /// Number of shots that estimators with a pile-up model assume.
    pub assumed_shots: u64,
}

impl Variant {
    /// With those effects.
    ///
    /// # Errors
    /// When a file of the scenario cannot be read or used.
    pub fn new(loaded: &Loaded, effects: EffectSet) -> Result<Self> {
        let mut loaded = loaded.clone();
        let off = Effect::ALL.into_iter().filter(|&effect| !effects.has(effect));
        off.for_each(|effect| switch_off(effect, &mut loaded.scenario));
        let shots = loaded.scenario.firmware.shots_of_a_frame();
        // Without pile-up the light is spread over the largest number of shots that can be configured: a shot is then
        // too faint for pile-up.
        let assumed_shots = if effects.has(Effect::PileUp) { shots } else { MOST_SHOTS };
        if assumed_shots != shots && loaded.scenario.estimator.assumed_shots == 0 {
            loaded.scenario.estimator.assumed_shots = assumed_shots;
        }
        let mut setup = Setup::of_counts(loaded)?;
        let has_errors =
            effects.has(Effect::Calibration) || effects.has(Effect::Drift) && setup.has_drifted();
        let has_taps = effects.has(Effect::Taps) || has_errors;
        let known = setup.known_delays().clone();
        let is_own = effects.has(Effect::UnevenTaps) || has_taps && is_even(&setup.params.tdc);
        // No chain has these names: a network was not trained for them.
        if !is_own && has_taps {
            setup.params.tdc = evened(&setup, has_errors);
            "even taps".clone_into(&mut setup.scenario.tdc.profile);
        }
        let bins = if is_own || has_taps {
            setup.bins()
        } else {
            "no taps".clone_into(&mut setup.scenario.tdc.profile);
            Bins::without_taps(&setup.params.tdc)
        };
        let assumed_bins = match (is_own, has_taps) {
            (true, _) => setup.known_bins(),
            (false, true) => Bins::of_tdc(&setup.params.tdc.clone().with_delays(known.evened())),
            (false, false) => bins.clone(),
        };
        setup.glass = setup.glass.map(|glass| Arc::new(glass.over(&assumed_bins.limits_ps())));
        Ok(Variant { effects, setup, bins, assumed_bins, assumed_shots })
    }

    /// Returns the acquisition of its histograms, as the estimator knows it.
    pub fn acquisition(&self) -> Acquisition<'_> {
        Acquisition::of(&self.setup, &self.assumed_bins, self.assumed_shots)
    }

    /// What its histograms are drawn from: without pile-up the same light spread over all the shots that
    /// estimators assume. It has no effect that joins shots.
    pub fn histograms(&self) -> Histograms {
        let part = self.setup.shots(1) as f64 / self.assumed_shots as f64;
        let budget = self.setup.budget.dimmed(part);
        let per_shot = per_shot(&Hazard::new(&budget), &self.bins, self.acquisition().jitter_ps);
        Histograms { per_shot, shots: self.assumed_shots }
    }
}

/// Standard deviation of a pulse without a width [ps].
pub fn shortest_ps(scenario: &Scenario) -> f64 {
    SHORTEST_BINS * scenario.tdc.bin_ps
}

/// Sets the keys of a scenario as they are without an effect. An effect without keys is left to the rest.
fn switch_off(effect: Effect, scenario: &mut Scenario) {
    if let Some(own) = effect.of_scenario() {
        return own.switch_off(scenario);
    }
    match effect {
        Effect::Ambient => scenario.ambient.irradiance_w_m2_nm = 0.0,
        Effect::DarkCounts => {
            (scenario.spad.dark_rate_hz, scenario.spad.dark_file) = (0.0, None);
        }
        Effect::PulseWidth => {
            let shortest_ps = shortest_ps(scenario);
            scenario.laser.pulse_sigma_ps = match scenario.laser.pulse_file.take() {
                Some(_) => shortest_ps,
                None => scenario.laser.pulse_sigma_ps.min(shortest_ps),
            };
        }
        Effect::Calibration => scenario.tdc.calibration = TdcCalibration::True,
        Effect::Drift => {
            (scenario.tdc.calibrated_at_c, scenario.tdc.calibrated_at_mv) = (None, None);
        }
        _ => {}
    }
}

/// Whether all taps are equal, to the femtosecond.
pub fn is_even(tdc: &tdc::Params) -> bool {
    let even = tdc.delays.evened();
    let pairs = tdc.delays.arrivals().iter().zip(even.arrivals());
    pairs.into_iter().all(|(own, even)| own.fs().abs_diff(even.fs()) <= 1)
}

/// The converter with as many taps, all alike; the errors of the ROM, if it keeps them, are those of the chain's
/// own.
pub fn evened(setup: &Setup, keeps_errors: bool) -> tdc::Params {
    let own = &setup.params.tdc;
    let of = |delays| {
        let (coarse_bits, stages) = (setup.scenario.tdc.coarse_bits, own.decoder.count_stages);
        tdc::Params::new(delays, own.decoder.scale, coarse_bits, stages)
            .with_decoder(own.decoder.encoder.decoder())
    };
    let even = of(own.delays.evened());
    if !keeps_errors {
        return even;
    }
    let right = of(own.delays.clone()).decoder.cal;
    let words = even.decoder.cal.iter().zip(&own.decoder.cal).zip(&right);
    let cal: Calibration = words
        .map(|((even, own), right)| U::new((even.get() + own.get()).saturating_sub(right.get())))
        .collect();
    even.with_calibration(cal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;

    fn loaded(keys: &[&str]) -> Loaded {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        scenario::load("kc705", &keys).unwrap()
    }

    fn all() -> EffectSet {
        EffectSet::of(Effect::ALL)
    }

    #[test]
    fn with_every_effect_it_is_the_scenario() {
        let loaded = loaded(&["tdc.profile=kintex7", "tdc.calibration=uniform"]);
        let (own, variant) =
            (Setup::of_counts(loaded.clone()).unwrap(), Variant::new(&loaded, all()).unwrap());
        assert_eq!(variant.bins, own.bins());
        assert_eq!((variant.assumed_shots, &variant.setup.scenario), (30_000, &own.scenario));
    }

    #[test]
    fn each_effect_changes_what_it_is_about_and_nothing_else() {
        let loaded = loaded(&["tdc.profile=kintex7", "laser.pulse_tail_ps=80"]);
        let (all, of) = (all(), |effects| Variant::new(&loaded, effects).unwrap());
        let own = of(all).setup.budget;
        let dark = of(all.without(Effect::Ambient)).setup.budget;
        assert_eq!((dark.ambient_rate_hz, dark.signal_per_shot), (0.0, own.signal_per_shot));
        assert_eq!(
            of(all.without(Effect::DarkCounts)).setup.budget.background_rate_hz(),
            own.ambient_rate_hz
        );
        let short = of(all.without(Effect::PulseWidth).without(Effect::PulseTail)).setup.budget;
        assert_eq!(short.pulse.sigma_ps(), 12.5);
        let linear = of(all.without(Effect::PileUp));
        assert_eq!((linear.assumed_shots, linear.setup.shots(1)), ((1 << 24) - 1, 30_000));
        // Every photon of the budget counts, but for the dark hits past the last bin.
        let hits = linear.histograms().per_shot.iter().sum::<f64>() * linear.assumed_shots as f64;
        let expected = 30_000.0 * (own.signal_per_shot + own.background_rate_hz() * 6.4e-9);
        assert!((hits / expected - 1.0).abs() < 5e-3, "{hits} {expected}");
    }

    #[test]
    fn taps_are_uneven_even_or_none() {
        let loaded = loaded(&["tdc.profile=kintex7"]);
        let spread_ps = |effects| {
            let bins = Variant::new(&loaded, effects).unwrap().bins;
            let widths = bins.spans()[1..255]
                .iter()
                .map(|span| (span.until.fs() - span.from.fs()) as f64 / 1e3);
            let (least, most) =
                widths.fold((f64::INFINITY, 0.0), |(a, b), ps| (f64::min(a, ps), f64::max(b, ps)));
            most - least
        };
        let none =
            all().without(Effect::UnevenTaps).without(Effect::Taps).without(Effect::Calibration);
        assert_eq!(spread_ps(none), 0.0);
        let even = spread_ps(none.with(Effect::Taps));
        assert!((even - 11.59).abs() < 0.05, "bins of two and three taps: {even}");
        assert!(spread_ps(none.with(Effect::UnevenTaps)) > 2.0 * even);
    }

    #[test]
    fn a_drift_is_in_the_bins_and_not_in_what_an_estimator_is_told() {
        let loaded = loaded(&["tdc.temperature_c=35", "tdc.calibrated_at_c=25"]);
        let of = |effects| Variant::new(&loaded, effects).unwrap();
        let middle_ps = |bins: &Bins| bins.edges_ps()[128];
        let drifted = of(all());
        // 1 % of an age of 5.6 ns or so.
        let moved_ps = middle_ps(&drifted.assumed_bins) - middle_ps(&drifted.bins);
        assert!((30.0..80.0).contains(&moved_ps.abs()), "{moved_ps} ps");
        let now = of(all().without(Effect::Drift));
        assert_eq!(now.bins, now.assumed_bins);
        // On even taps it is as large.
        let even = of(all().without(Effect::UnevenTaps));
        let even_ps = middle_ps(&even.assumed_bins) - middle_ps(&even.bins);
        assert!((even_ps - moved_ps).abs() < 13.0, "{even_ps} ps, {moved_ps} ps");
    }

    #[test]
    fn a_rom_of_equal_taps_is_right_for_even_taps_but_for_its_own_errors() {
        let loaded = loaded(&["tdc.profile=kintex7", "tdc.calibration=uniform"]);
        let even = all().without(Effect::UnevenTaps);
        let [with, without] = [even, even.without(Effect::Calibration)]
            .map(|effects| Variant::new(&loaded, effects).unwrap().setup.params.tdc);
        let own = Setup::of_counts(loaded).unwrap().params.tdc;
        let right = tdc::Params::of_chain(own.delays.clone()).decoder.cal;
        for n in 200..600 {
            let error = |a: &Calibration, b: &Calibration| a[n].get() as i64 - b[n].get() as i64;
            let [found, expected] =
                [error(&with.decoder.cal, &without.decoder.cal), error(&own.decoder.cal, &right)];
            assert_eq!(found, expected, "{n}");
        }
    }
}
