//! The estimators by the names that the command line has for them.

use tofsim::error::Input;
use tofsim::network::Network;
use tofsim::scenario::{EstimatorKind as Socket, Scenario};
use tofsim::sim::setup::Setup;

use super::acquisition::Acquisition;
use super::centroid::Centroid;
use super::estimator::Estimator;
use super::likelihood::Likelihood;
use super::likelihood::two_echoes::{self, TwoEchoes};
use super::likelihood_estimator::{self, LikelihoodEstimator};
use super::matched_filter::MatchedFilter;
use super::network::{fixed, float};
use super::peak_detection::PeakDetection;
use super::subtraction::{self, Subtraction};

/// An estimator's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EstimatorKind {
    /// The network in fixed point, bit for bit as the firmware
    Network,
    /// The network in double precision
    NetworkFloat,
    /// Argmax with centroid correction, bit for bit as the firmware's other estimator
    Centroid,
    /// The thesis's peak detection, on the bins of the chain
    Peak,
    /// Peak detection on a lit histogram less a dark one, of half the shots each
    Subtraction,
    /// Maximum likelihood with pile-up in the model
    Likelihood,
    /// Maximum likelihood of two echoes where two are sure, of one elsewhere
    TwoEchoes,
    /// Maximum likelihood in integers, bit for bit as the firmware would
    LikelihoodEstimator,
    /// Matched filter after Coates's correction of pile-up
    Matched,
}

impl EstimatorKind {
    /// All of them: the word on the command line, the kind, what it does.
    pub const ALL: [(&'static str, Self, &'static str); 9] = [
        ("network", Self::Network, "The network in fixed point, bit for bit as the firmware"),
        ("network-float", Self::NetworkFloat, "The network in double precision"),
        (
            "centroid",
            Self::Centroid,
            "Argmax with centroid correction, bit for bit as the firmware's other estimator",
        ),
        ("peak", Self::Peak, "The thesis's peak detection, on the bins of the chain"),
        (
            subtraction::NAME,
            Self::Subtraction,
            "Peak detection on a lit histogram less a dark one, of half the shots each",
        ),
        ("likelihood", Self::Likelihood, "Maximum likelihood with pile-up in the model"),
        (
            two_echoes::NAME,
            Self::TwoEchoes,
            "Maximum likelihood of two echoes where two are sure, of one elsewhere",
        ),
        (
            likelihood_estimator::NAME,
            Self::LikelihoodEstimator,
            "Maximum likelihood in integers, bit for bit as the firmware would",
        ),
        ("matched", Self::Matched, "Matched filter after Coates's correction of pile-up"),
    ];
}

/// What there is to make an estimator of.
#[derive(Clone, Copy, Debug)]
pub struct EstimatorInputs<'a> {
    /// The histograms.
    pub acquisition: Acquisition<'a>,
    /// The network in the depth estimator.
    pub network: &'a Network,
    /// The instrument, whose scene does not matter.
    pub setup: &'a Setup,
}

impl EstimatorKind {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind, _)| *kind == self).map_or("", |(name, ..)| name)
    }

    /// Whether it is a network, which knows what it was trained for.
    pub fn is_network(self) -> bool {
        matches!(self, EstimatorKind::Network | EstimatorKind::NetworkFloat)
    }

    /// What is in the scenario's socket, bit for bit as the firmware.
    pub fn in_socket(scenario: &Scenario) -> Self {
        match scenario.estimator.kind {
            Socket::Network => EstimatorKind::Network,
            Socket::Centroid => EstimatorKind::Centroid,
            Socket::Likelihood => EstimatorKind::LikelihoodEstimator,
        }
    }

    /// The estimator of that name.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails, or the estimator's model does not hold for the instrument.
    pub fn estimator(self, inputs: &EstimatorInputs) -> Result<Box<dyn Estimator>, Input> {
        let EstimatorInputs { acquisition, network, setup } = inputs;
        acquisition.check()?;
        let (shots, bins) = (acquisition.shots, acquisition.bins);
        let size = &setup.params.histogram;
        Ok(match self {
            EstimatorKind::Network => Box::new(fixed(network, size)),
            EstimatorKind::NetworkFloat => Box::new(float(network, size)),
            EstimatorKind::Centroid => Box::new(Centroid(setup.params.centroid_estimator)),
            EstimatorKind::Peak => Box::new(PeakDetection::of_bins(shots, bins)),
            EstimatorKind::Subtraction => Box::new(Subtraction::of_bins(shots, bins)?),
            EstimatorKind::Likelihood => Box::new(Likelihood::new(acquisition)?),
            EstimatorKind::TwoEchoes => Box::new(TwoEchoes::new(acquisition)?),
            EstimatorKind::LikelihoodEstimator => {
                Box::new(LikelihoodEstimator::new(setup.likelihood(shots)?))
            }
            EstimatorKind::Matched => Box::new(MatchedFilter::new(acquisition)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use tofsim::kernel::pulse::Pulse;

    use super::*;

    #[test]
    fn every_estimator_answers_to_its_name() {
        let setup = &Setup::load("kc705", &["tdc.profile=ideal"]).unwrap();
        let bins = &setup.bins();
        let network = &Network::builtin("ideal").unwrap().unwrap();
        let gaussian = |sigma_ps| Pulse::Gaussian { sigma_ps };
        let pulse = gaussian(137.0);
        let acquisition = Acquisition::new(bins, 30_000, &pulse);
        let needs = EstimatorInputs { acquisition, network, setup };
        for (name, kind, _) in EstimatorKind::ALL {
            assert_eq!(kind.estimator(&needs).unwrap().name(), name);
        }
        for (shots, sigma_ps, field) in
            [(0, 137.0, "shots = 0"), (1 << 24, 137.0, "shots"), (1, f64::NAN, "pulse = NaN")]
        {
            let pulse = gaussian(sigma_ps);
            let acquisition = Acquisition::new(bins, shots, &pulse);
            let needs = EstimatorInputs { acquisition, network, setup };
            let fault = EstimatorKind::Peak.estimator(&needs).err().unwrap().to_string();
            assert!(fault.contains(field), "{fault}");
        }
    }
}
