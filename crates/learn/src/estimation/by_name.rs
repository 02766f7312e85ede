//! The estimators by the names that the command line has for them.

use tofsim::error::Input;
use tofsim::firmware::centroid_estimator;
use tofsim::network::Network;

use super::acquisition::Acquisition;
use super::centroid::Centroid;
use super::estimator::Estimator;
use super::likelihood::Likelihood;
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
    /// Matched filter after Coates's correction of pile-up
    Matched,
}

impl EstimatorKind {
    /// All of them: the word on the command line, the kind, what it does.
    pub const ALL: [(&'static str, Self, &'static str); 7] = [
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
    /// The centroid estimator, and how large the histogram is.
    pub centroid: &'a centroid_estimator::Params,
}

impl EstimatorKind {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind, _)| *kind == self).map_or("", |(name, ..)| name)
    }

    /// The estimator of that name.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn estimator(self, inputs: &EstimatorInputs) -> Result<Box<dyn Estimator>, Input> {
        let EstimatorInputs { acquisition, network, centroid } = inputs;
        acquisition.check()?;
        let (shots, bins) = (acquisition.shots, acquisition.bins);
        Ok(match self {
            EstimatorKind::Network => Box::new(fixed(network, &centroid.histogram)),
            EstimatorKind::NetworkFloat => Box::new(float(network, &centroid.histogram)),
            EstimatorKind::Centroid => Box::new(Centroid(**centroid)),
            EstimatorKind::Peak => Box::new(PeakDetection::of_bins(shots, bins)),
            EstimatorKind::Subtraction => Box::new(Subtraction::of_bins(shots, bins)?),
            EstimatorKind::Likelihood => Box::new(Likelihood::new(acquisition)?),
            EstimatorKind::Matched => Box::new(MatchedFilter::new(acquisition)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::firmware::tdc;
    use tofsim::kernel::Time;
    use tofsim::optics::Bins;
    use tofsim::scenario::{builtin::Source, chain};

    #[test]
    fn every_estimator_answers_to_its_name() {
        let delays = chain::load("ideal", &Source::Folder("".into()), Time::from_ns(8)).unwrap();
        let bins = &Bins::of_tdc(&tdc::Params::of_chain(delays));
        let network = &Network::builtin("ideal").unwrap().unwrap();
        let acquisition = Acquisition::new(bins, 30_000, 137.0);
        let centroid = &centroid_estimator::Params::default();
        let needs = EstimatorInputs { acquisition, network, centroid };
        for (name, kind, _) in EstimatorKind::ALL {
            assert_eq!(kind.estimator(&needs).unwrap().name(), name);
        }
        for (shots, pulse_sigma_ps, field) in
            [(0, 137.0, "shots = 0"), (1 << 24, 137.0, "shots"), (1, f64::NAN, "sigma_ps = NaN")]
        {
            let acquisition = Acquisition::new(bins, shots, pulse_sigma_ps);
            let needs = EstimatorInputs { acquisition, network, centroid };
            let fault = EstimatorKind::Peak.estimator(&needs).err().unwrap().to_string();
            assert!(fault.contains(field), "{fault}");
        }
    }
}
