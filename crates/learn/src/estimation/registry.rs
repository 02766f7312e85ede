//! The registry of estimators: what the command line, studies, Python and notes know of each.

use tofsim::error::{Error, Input};
use tofsim::firmware::histogram_builder;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::firmware::tof_top::slot::{Assumptions, SlotEstimator};
use tofsim::network::Network;
use tofsim::scenario::Scenario;
use tofsim::sim::setup::Setup;
use tofsim::{firmware_estimators, in_slot};

use super::acquisition::Acquisition;
use super::estimator::Estimator;
use super::in_firmware::{InFirmware, likelihood_estimator};
use super::likelihood::Likelihood;
use super::likelihood::two_echoes::{self, TwoEchoes};
use super::matched_filter::MatchedFilter;
use super::network::{fixed, float};
use super::peak_detection::PeakDetection;
use super::subtraction::{self, Subtraction};

/// An estimator of the registry.
struct Registered {
    /// Name on the command line.
    name: &'static str,
    /// Description of the estimator for help.
    about: &'static str,
    /// Its block, where the firmware computes the same bits, and what that assumes of the histogram.
    firmware: Option<(FirmwareEstimator, Assumptions)>,
    /// Inputs that it needs besides histograms.
    needs: Needs,
    make: fn(&EstimatorInputs) -> Result<Box<dyn Estimator>, Input>,
}

/// Inputs that an estimator needs besides the histograms of lit frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// No further inputs; the model of the instrument is sufficient.
    Model,
    /// A network for such histograms, which knows what it was trained for.
    Network,
    /// A dark histogram beside each lit one.
    Dark,
}

impl Registered {
    /// An estimator that no firmware has, and that needs nothing more.
    const fn new(
        name: &'static str,
        about: &'static str,
        make: fn(&EstimatorInputs) -> Result<Box<dyn Estimator>, Input>,
    ) -> Self {
        Registered { name, about, firmware: None, needs: Needs::Model, make }
    }

    const fn in_firmware(
        firmware: FirmwareEstimator,
        assumptions: Assumptions,
        make: fn(&EstimatorInputs) -> Result<Box<dyn Estimator>, Input>,
    ) -> Self {
        let needs =
            if let Assumptions::Training = assumptions { Needs::Network } else { Needs::Model };
        let (name, about) = (firmware.estimator(), firmware.about());
        Registered { name, about, firmware: Some((firmware, assumptions)), needs, make }
    }

    const fn needs(self, needs: Needs) -> Self {
        Registered { needs, ..self }
    }
}

/// Makes the registry: the estimators of the firmware, as it lists them, and those that no firmware has.
macro_rules! registry {
    (($($(#[$doc:meta])* $Kind:ident = $entry:expr;)+); $(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $estimator:literal: $module:ident::$Block:ident,
    )+) => {
        /// An estimator's name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum EstimatorKind {
            $(#[doc = concat!($about, ", bit for bit as `", stringify!($module), "`.")] $Name,)+
            $($(#[$doc])* $Kind,)+
        }

        const REGISTRY: &[Registered] = &[
            $(Registered::in_firmware(
                FirmwareEstimator::$Name,
                <tofsim::firmware::$module::$Block as SlotEstimator>::ASSUMES,
                |inputs| in_firmware(FirmwareEstimator::$Name, inputs),
            ),)+
            $($entry,)+
        ];

        impl EstimatorKind {
            /// Every estimator: its name on the command line, the kind, what it does.
            pub const ALL: &[(&'static str, Self, &'static str)] =
                &[$(listed(EstimatorKind::$Name),)+ $(listed(EstimatorKind::$Kind),)+];
        }
    };
}

firmware_estimators!([registry] (
    /// The network in double precision.
    NetworkFloat = Registered::new(
        "network-float",
        "The network in double precision",
        |i| Ok(Box::new(float(i.network, i.size()))),
    )
    .needs(Needs::Network);
    /// The thesis's peak detection.
    Peak = Registered::new(
        "peak",
        "The thesis's peak detection, on the bins of the chain",
        |i| Ok(Box::new(PeakDetection::of_bins(i.acquisition.shots, i.acquisition.bins))),
    );
    /// Peak detection on a lit histogram less a dark one.
    Subtraction = Registered::new(
        subtraction::NAME,
        "Peak detection on the difference of a lit and a dark histogram, half the shots each",
        |i| Ok(Box::new(Subtraction::of_bins(i.acquisition.shots, i.acquisition.bins)?)),
    )
    .needs(Needs::Dark);
    /// Maximum likelihood in double precision.
    Likelihood = Registered::new(
        "likelihood",
        "Maximum likelihood with pile-up in the model",
        |i| Ok(Box::new(Likelihood::new(&i.acquisition)?)),
    );
    /// Maximum likelihood of two echoes.
    TwoEchoes = Registered::new(
        two_echoes::NAME,
        "Maximum likelihood of two echoes if both are certain, else of one",
        |i| Ok(Box::new(TwoEchoes::new(&i.acquisition)?)),
    );
    /// Matched filter.
    Matched = Registered::new(
        "matched",
        "Matched filter after Coates's correction of pile-up",
        |i| Ok(Box::new(MatchedFilter::new(&i.acquisition)?)),
    );
));

const fn listed(kind: EstimatorKind) -> (&'static str, EstimatorKind, &'static str) {
    let Registered { name, about, .. } = REGISTRY[kind as usize];
    (name, kind, about)
}

/// Makes an estimator of the firmware, with the network and the shots of the histograms where it has such.
fn in_firmware(
    estimator: FirmwareEstimator,
    i: &EstimatorInputs,
) -> Result<Box<dyn Estimator>, Input> {
    Ok(match estimator {
        FirmwareEstimator::Network => Box::new(fixed(i.network, i.size())),
        FirmwareEstimator::LikelihoodEstimator => {
            Box::new(likelihood_estimator(i.setup.likelihood(i.acquisition.shots)?))
        }
        other => in_slot!(other, E => Box::new(InFirmware::<E>::of(other, i.setup))),
    })
}

/// Inputs from which an estimator is made.
#[derive(Clone, Copy, Debug)]
pub struct EstimatorInputs<'a> {
    /// The histograms.
    pub acquisition: Acquisition<'a>,
    /// The network in the depth estimator.
    pub network: &'a Network,
    /// The instrument, whose scene does not matter.
    pub setup: &'a Setup,
}

impl EstimatorInputs<'_> {
    /// Size of the histograms.
    fn size(&self) -> &histogram_builder::Params {
        &self.setup.params.histogram
    }
}

impl EstimatorKind {
    fn registered(self) -> &'static Registered {
        &REGISTRY[self as usize]
    }

    /// Returns the estimator of that name on the command line.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, ..)| *known == name).map(|(_, kind, _)| *kind)
    }

    /// Names of all estimators.
    pub fn names() -> impl Iterator<Item = &'static str> + Clone {
        Self::ALL.iter().map(|(name, ..)| *name)
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        self.registered().name
    }

    /// Returns the inputs that it needs besides the histograms of lit frames.
    pub fn needs(self) -> Needs {
        self.registered().needs
    }

    /// Returns whether it is a network, which has limits of its training.
    pub fn is_network(self) -> bool {
        self.needs() == Needs::Network
    }

    /// Returns whether it computes in integers, bit for bit like a block of the firmware.
    pub fn is_in_firmware(self) -> bool {
        self.registered().firmware.is_some()
    }

    /// The estimator in the scenario's firmware, bit for bit.
    pub fn in_socket(scenario: &Scenario) -> Self {
        // Those of the firmware come first, in its order.
        Self::ALL[scenario.estimator.kind as usize].1
    }

    /// Returns whether it takes histograms of any bins: its model is of pulse and ambient light alone, and it has no
    /// constants of an instrument.
    pub fn takes_any_bins(self) -> bool {
        use EstimatorKind::{Likelihood, Matched, TwoEchoes};
        matches!(self, Likelihood | Matched | TwoEchoes)
    }

    /// Checks what the estimator needs of a setup beside its histograms.
    ///
    /// # Errors
    /// When it is a network for other histograms.
    pub fn check(self, setup: &Setup) -> Result<(), Error> {
        if self.is_network() { setup.check_network() } else { Ok(()) }
    }

    /// Returns the assumptions of an estimator of the firmware.
    pub(super) fn assumptions(self) -> Option<Assumptions> {
        self.registered().firmware.map(|(_, assumptions)| assumptions)
    }

    /// Makes the estimator.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails, or the estimator's model does not hold for the instrument.
    pub fn estimator(self, inputs: &EstimatorInputs) -> Result<Box<dyn Estimator>, Input> {
        inputs.acquisition.check()?;
        (self.registered().make)(inputs)
    }
}

#[cfg(test)]
mod tests;
