//! Input ports of every estimator, as they stand before an edge.

use crate::firmware_estimators;

macro_rules! slot_inputs {
    ($(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $estimator:literal: $module:ident::$Block:ident,
    )+) => {
        /// Input ports of every estimator.
        #[derive(Clone, Copy, Debug)]
        pub struct SlotInputs {
            $(
                #[doc = concat!("Of `", stringify!($module), "`.")]
                pub $module: crate::firmware::$module::In,
            )+
        }
    };
}

firmware_estimators!([slot_inputs]);
