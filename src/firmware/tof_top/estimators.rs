//! The estimators of the firmware by name: the slot, scenarios and the Verilog parameter `Estimator` share their list.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::firmware_estimators;

use super::slot::SlotEstimator;

macro_rules! enumerated {
    ($(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $estimator:literal: $module:ident::$Block:ident,
    )+) => {
        /// The estimator in the estimator slot.
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema,
        )]
        #[schemars(rename = "EstimatorKind")]
        pub enum FirmwareEstimator {
            $(
                #[doc = concat!($about, " (`", stringify!($module), "`).")]
                #[serde(rename = $name)]
                $Name,
            )+
        }

        impl FirmwareEstimator {
            /// Every estimator, in the order of the Verilog parameter's values.
            pub const ALL: &[Self] = &[$(Self::$Name),+];

            /// Its meaning for help, without a full stop.
            pub const fn about(self) -> &'static str {
                match self {
                    $(Self::$Name => $about.trim_ascii(),)+
                }
            }

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
            pub const fn module(self) -> &'static str {
                match self {
                    $(Self::$Name => stringify!($module),)+
                }
            }
        }
    };
}

firmware_estimators!([enumerated]);

/// Evaluates an expression in which a name stands for the block of an estimator: the one match over
/// [`FirmwareEstimator`].
#[macro_export]
macro_rules! in_slot {
    ($estimator:expr, $Chosen:ident => $body:expr) => {
        $crate::firmware_estimators!([$crate::in_slot_arms] ($estimator) $Chosen $body)
    };
}

/// The match of [`in_slot`].
#[doc(hidden)]
#[macro_export]
macro_rules! in_slot_arms {
    (($estimator:expr) $Chosen:ident $body:expr; $(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $cli:literal: $module:ident::$Block:ident,
    )+) => {
        match $estimator {
            $($crate::firmware::tof_top::FirmwareEstimator::$Name => {
                type $Chosen = $crate::firmware::$module::$Block;
                $body
            })+
        }
    };
}

impl Default for FirmwareEstimator {
    /// The first of the list, as in the Verilog.
    fn default() -> Self {
        Self::ALL[0]
    }
}

impl FirmwareEstimator {
    /// Its value of the Verilog parameter `Estimator`.
    pub fn number(self) -> u64 {
        self as u64
    }

    /// Whether the estimator outputs a sigma, a status and `valid` beside the depth.
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
