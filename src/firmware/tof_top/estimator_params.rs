//! The parameters of the estimators in the top.

use std::sync::Arc;

use crate::firmware::histogram_builder;
use crate::firmware_estimators;

use super::slot::SlotEstimator;

macro_rules! parameters {
    ($(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $estimator:literal: $module:ident::$Block:ident,
    )+) => {
        /// Parameters of every estimator.
        #[derive(Clone, Debug)]
        pub struct EstimatorParams {
            $(
                #[doc = concat!("Parameters of `", stringify!($module), "`.")]
                pub $module: Arc<<crate::firmware::$module::$Block as SlotEstimator>::Params>,
            )+
        }

        impl EstimatorParams {
            /// Parameters for histograms of that size, as they are without a scenario.
            pub fn of(histogram: &histogram_builder::Params) -> Self {
                EstimatorParams {
                    $($module: Arc::new(crate::firmware::$module::$Block::params_for(histogram)),)+
                }
            }
        }
    };
}

firmware_estimators!([parameters]);
