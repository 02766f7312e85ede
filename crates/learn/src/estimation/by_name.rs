//! The estimators by the names that the command line has for them.

use tofsim::error::Input;
use tofsim::firmware::centroid_estimator;
use tofsim::network::Network;
use tofsim::optics::Bins;

use super::centroid::Centroid;
use super::likelihood::Likelihood;
use super::matched_filter::MatchedFilter;
use super::network::{FixedNetwork, FloatNetwork};
use super::peak_detection::PeakDetection;
use super::subtraction::Subtraction;
use super::{Estimator, Failure, Pair};

/// An estimator's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
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

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 7] = [
        Kind::Network,
        Kind::NetworkFloat,
        Kind::Centroid,
        Kind::Peak,
        Kind::Subtraction,
        Kind::Likelihood,
        Kind::Matched,
    ];

    /// In a word, as its estimator calls itself.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::Network => "network",
            Kind::NetworkFloat => "network-float",
            Kind::Centroid => "centroid",
            Kind::Peak => "peak",
            Kind::Subtraction => "subtraction",
            Kind::Likelihood => "likelihood",
            Kind::Matched => "matched",
        }
    }
}

/// How the histograms come about, as far as estimators know it.
#[derive(Clone, Copy, Debug)]
pub struct Acquisition<'a> {
    /// Which avalanche times give which code.
    pub bins: &'a Bins,
    /// Shots of a histogram, or of a dark and a lit one together [shots].
    pub shots: u64,
    /// Standard deviation of the pulse as the detector times it [ps].
    pub pulse_sigma_ps: f64,
}

/// What there is to make an estimator of.
#[derive(Clone, Copy, Debug)]
pub struct Needs<'a> {
    /// The histograms.
    pub acquisition: Acquisition<'a>,
    /// The network in the depth estimator.
    pub network: &'a Network,
    /// The centroid estimator.
    pub centroid: &'a centroid_estimator::Params,
}

impl Acquisition<'_> {
    /// Whether there is anything to estimate from.
    ///
    /// # Errors
    /// For no bins, no shots or more than a bin of 16 bits holds, or a width that is no width.
    pub fn check(&self) -> Result<(), Input> {
        let fault = |field, expected| Input::new("acquisition", expected).field(field);
        if self.bins.spans().is_empty() {
            return Err(fault("bins", "expected a chain that gives a code at all"));
        }
        if !(1..=65_535).contains(&self.shots) {
            return Err(fault("shots", "expected 1 to 65535").value(self.shots));
        }
        if !(1.0..=1e6).contains(&self.pulse_sigma_ps) {
            let value = self.pulse_sigma_ps;
            return Err(fault("pulse_sigma_ps", "expected 1 to 1e6 [ps]").value(value));
        }
        Ok(())
    }
}

impl Kind {
    /// The estimator of that name.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn estimator(self, needs: &Needs) -> Result<Box<dyn Estimator + Send>, Input> {
        needs.acquisition.check()?;
        Ok(match self {
            Kind::Network => Box::new(FixedNetwork::new(needs.network)),
            Kind::NetworkFloat => Box::new(FloatNetwork::new(needs.network)),
            Kind::Centroid => Box::new(Centroid::new(needs.centroid)),
            Kind::Peak => {
                Box::new(PeakDetection::of_bins(needs.acquisition.shots, needs.acquisition.bins))
            }
            Kind::Subtraction => {
                Box::new(Subtraction::of_bins(needs.acquisition.shots, needs.acquisition.bins)?)
            }
            Kind::Likelihood => Box::new(Likelihood::new(&needs.acquisition)?),
            Kind::Matched => Box::new(MatchedFilter::new(&needs.acquisition)?),
        })
    }
}

impl<T: Estimator + Send + ?Sized> Estimator for Box<T> {
    fn name(&self) -> &'static str {
        (**self).name()
    }

    fn estimate(&self, histogram: &tofsim::network::Histogram) -> Result<f64, Failure> {
        (**self).estimate(histogram)
    }

    fn needs_dark(&self) -> bool {
        (**self).needs_dark()
    }

    fn estimate_pair(&self, pair: &Pair) -> Result<f64, Failure> {
        (**self).estimate_pair(pair)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::kernel::Time;
    use tofsim::scenario::{builtin::Source, chain};

    #[test]
    fn every_estimator_answers_to_its_name() {
        let delays = chain::load("ideal", &Source::working_directory()).unwrap();
        let period = Time::from_ns(8);
        let bins = &Bins::of_chain(&delays, &delays.calibration(period), period);
        let network = &Network::builtin("ideal").unwrap().unwrap();
        let acquisition = Acquisition { bins, shots: 30_000, pulse_sigma_ps: 137.0 };
        let centroid = &centroid_estimator::Params::default();
        let needs = Needs { acquisition, network, centroid };
        for kind in Kind::ALL {
            assert_eq!(kind.estimator(&needs).unwrap().name(), kind.name());
        }
        for (shots, pulse_sigma_ps, field) in
            [(0, 137.0, "shots = 0"), (65_536, 137.0, "shots"), (1, f64::NAN, "sigma_ps = NaN")]
        {
            let acquisition = Acquisition { bins, shots, pulse_sigma_ps };
            let needs = Needs { acquisition, network, centroid };
            let fault = Kind::Peak.estimator(&needs).err().unwrap().to_string();
            assert!(fault.contains(field), "{fault}");
        }
    }
}
