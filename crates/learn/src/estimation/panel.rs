//! Several estimators over the same histograms.

use tofsim::error::{Input, Result};
use tofsim::optics::Bins;
use tofsim::sim::setup::Setup;

use super::acquisition::Acquisition;
use super::estimator::{Estimate, Estimator, Failure, Found, HistogramPair};
use super::registry::{EstimatorInputs, EstimatorKind, Needs};

/// Estimators that look at each histogram of a run, beside the one in the firmware.
#[derive(Default)]
pub struct Panel {
    estimators: Vec<Box<dyn Estimator>>,
}

impl Panel {
    /// Estimators for the histograms of a scenario.
    ///
    /// # Errors
    /// When they cannot be made for it.
    pub fn new(kinds: &[EstimatorKind], setup: &Setup) -> Result<Self> {
        let bins = &setup.known_bins();
        let estimator = |kind: &EstimatorKind| {
            kind.check(setup)?;
            let shots = if kind.needs() == Needs::Dark {
                setup.scenario.firmware.shots_per_frame
            } else {
                setup.params.frame_ctrl.shots_per_frame.into()
            };
            made(*kind, setup, bins, shots)
        };
        let estimators = kinds.iter().map(estimator);
        Ok(Panel { estimators: estimators.collect::<Result<_>>()? })
    }

    /// Estimators for the histograms of a sensor with other bins; pulse, shots and delay are a scenario's.
    ///
    /// # Errors
    /// When one is for the bins of an instrument, or cannot be made.
    pub fn of_bins(kinds: &[EstimatorKind], setup: &Setup, bins: &Bins) -> Result<Self> {
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        let estimator = |kind: &EstimatorKind| {
            if !kind.takes_any_bins() {
                let all = EstimatorKind::ALL.iter().filter(|(_, kind, _)| kind.takes_any_bins());
                let names: Vec<_> = all.map(|(name, ..)| *name).collect();
                let expected = format!(
                    "it is for {} bins as tdc.bins says; expected one of {}",
                    setup.params.histogram.bins,
                    names.join(", ")
                );
                return Err(Input::new("--estimator", expected).value(kind.name()).into());
            }
            made(*kind, setup, bins, shots)
        };
        let estimators = kinds.iter().map(estimator);
        Ok(Panel { estimators: estimators.collect::<Result<_>>()? })
    }

    /// Adds an estimator, such as a custom one, after all others.
    pub fn add(&mut self, estimator: Box<dyn Estimator>) {
        self.estimators.push(estimator);
    }

    /// The estimators alone, to be evaluated.
    pub fn into_estimators(self) -> Vec<Box<dyn Estimator>> {
        self.estimators
    }

    /// Returns the estimates for a frame, in the order in which the estimators were named.
    pub fn read(&self, histogram: &[u32]) -> Vec<Estimate> {
        self.each(|estimator| estimator.find(histogram))
    }

    /// Returns the estimates for a dark and a lit frame; most estimators look at the lit one only.
    pub fn read_pair(&self, pair: &HistogramPair) -> Vec<Estimate> {
        self.each(|estimator| {
            if estimator.needs_dark() {
                estimator.estimate_pair(pair).map(Found::depth)
            } else {
                estimator.find(&pair.lit)
            }
        })
    }

    fn each(
        &self,
        find: impl Fn(&dyn Estimator) -> std::result::Result<Found, Failure>,
    ) -> Vec<Estimate> {
        let estimators = self.estimators.iter().map(AsRef::as_ref);
        estimators.map(|one| Found::estimate(one.name(), find(one))).collect()
    }
}

/// The estimator of that kind for histograms of so many shots in those bins.
fn made(kind: EstimatorKind, setup: &Setup, bins: &Bins, shots: u64) -> Result<Box<dyn Estimator>> {
    let (acquisition, network) = (Acquisition::of(setup, bins, shots), &setup.network);
    Ok(kind.estimator(&EstimatorInputs { acquisition, network, setup })?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::acquisition::most_probable;
    use tofsim::optics::{BinProbabilities, Hazard};
    use tofsim::scenario;

    #[test]
    fn each_says_where_the_target_is_or_why_not() {
        let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
        let kinds = [EstimatorKind::Matched, EstimatorKind::Network, EstimatorKind::Peak];
        let panel = Panel::new(&kinds, &setup).unwrap();
        let nothing = panel.read(&[0; 256]);
        let failures: Vec<_> = nothing.iter().map(|reading| reading.failure.as_deref()).collect();
        assert_eq!(failures, [Some("no hits"), None, Some("no hits")]);
        for reading in &nothing {
            let words: Vec<_> = reading.failure.iter().map(String::as_str).collect();
            assert_eq!((reading.status.words(), reading.valid), (words.clone(), words.is_empty()));
        }
        assert!(Panel::default().read(&[0; 256]).is_empty());
    }

    #[test]
    fn those_that_know_of_the_laser_s_delay_take_it_out_again() {
        use EstimatorKind::{Likelihood, LikelihoodEstimator, Matched, Peak};
        let readings = |delay_ps: f64| {
            let set = [format!("laser.delay_ps={delay_ps}"), "target.distance_m=0.4".to_owned()];
            let setup = Setup::new(scenario::load("kc705", &set).unwrap()).unwrap();
            let codes = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
            let histogram = most_probable(codes.of_code(), 30_000);
            let panel = Panel::new(&[Likelihood, LikelihoodEstimator, Matched, Peak], &setup);
            panel.unwrap().read(&histogram).into_iter().map(|one| one.depth_m.unwrap())
        };
        // 1500 ps are 0.2248 m; a peak is as fine as its smoothed bins.
        for (k, (at_once, late)) in readings(0.0).zip(readings(1500.0)).enumerate() {
            let (expected, near) = if k < 3 { (at_once, 2e-3) } else { (at_once + 0.2248, 2e-2) };
            assert!((late - expected).abs() < near, "{k}: {late} {at_once}");
            assert!(k == 3 || (late - 0.4).abs() < 1e-3, "{k}: {late}");
        }
    }

    #[test]
    fn an_estimator_of_one_s_own_is_asked_last() {
        struct Own;
        impl Estimator for Own {
            fn name(&self) -> &'static str {
                "own"
            }

            fn estimate(&self, histogram: &[u32]) -> std::result::Result<f64, Failure> {
                Ok(f64::from(histogram[7]))
            }
        }
        let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
        let mut panel = Panel::new(&[EstimatorKind::Network], &setup).unwrap();
        let own: Box<dyn Estimator + Send + Sync> = Box::new(Own);
        panel.add(own);
        let readings = panel.read(&[3; 256]);
        assert_eq!((readings[1].estimator, readings[1].depth_m), ("own", Some(3.0)));
    }
}
