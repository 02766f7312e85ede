//! The estimators of the firmware: the list that the slot, scenarios and the Verilog parameter `Estimator` share.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::slot::SlotEstimator;

macro_rules! estimators {
    ($($(#[$doc:meta])* $Name:ident = $name:literal, $estimator:literal: $module:ident,)+) => {
        /// What is in the estimator's socket.
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema,
        )]
        #[serde(rename_all = "snake_case")]
        #[schemars(rename = "EstimatorKind")]
        pub enum FirmwareEstimator {
            $($(#[$doc])* $Name,)+
        }

        impl FirmwareEstimator {
            /// Every estimator, in the order of the Verilog parameter's values.
            pub const ALL: &[Self] = &[$(Self::$Name),+];

            /// Its name in a scenario.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$Name => $name,)+
                }
            }

            /// Its name on the command line, as of an estimator that sees histograms of any origin.
            pub const fn estimator(self) -> &'static str {
                match self {
                    $(Self::$Name => $estimator,)+
                }
            }

            /// Name of its module.
            pub fn module(self) -> &'static str {
                match self {
                    $(Self::$Name => stringify!($module),)+
                }
            }
        }
    };
}

estimators! {
    /// The neural network (`depth_estimator`).
    #[default]
    Network = "network", "network": depth_estimator,
    /// Argmax with centroid correction (`centroid_estimator`).
    Centroid = "centroid", "centroid": centroid_estimator,
    /// Maximum likelihood in integers (`likelihood_estimator`).
    Likelihood = "likelihood", "likelihood_estimator": likelihood_estimator,
}

/// Evaluates an expression in which a name stands for the block of an estimator: the one match over
/// [`FirmwareEstimator`].
#[macro_export]
macro_rules! in_slot {
    ($estimator:expr, $Block:ident => $body:expr) => {
        match $estimator {
            $crate::firmware::tof_top::FirmwareEstimator::Network => {
                type $Block = $crate::firmware::depth_estimator::DepthEstimator;
                $body
            }
            $crate::firmware::tof_top::FirmwareEstimator::Centroid => {
                type $Block = $crate::firmware::centroid_estimator::CentroidEstimator;
                $body
            }
            $crate::firmware::tof_top::FirmwareEstimator::Likelihood => {
                type $Block = $crate::firmware::likelihood_estimator::LikelihoodEstimator;
                $body
            }
        }
    };
}

impl FirmwareEstimator {
    /// Its value of the Verilog parameter `Estimator`.
    pub fn number(self) -> u64 {
        self as u64
    }

    /// Whether it states a sigma, a status and `valid` beside the depth.
    pub fn states_sigma(self) -> bool {
        in_slot!(self, E => E::STATES_SIGMA)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimator_has_one_name_in_a_scenario_and_in_the_list() {
        for &estimator in FirmwareEstimator::ALL {
            let written = serde_json::to_value(estimator).unwrap();
            assert_eq!(written, estimator.name());
            assert!(
                in_slot!(estimator, E => std::any::type_name::<E>()).contains(estimator.module())
            );
        }
    }
}
