//! The estimators in the top: their ports, parameters and clock.

use crate::{firmware_estimators, in_slot};

use super::slot::SlotEstimator;
use super::{Params, TofTop, Wires};

/// An estimator of the list: its place in the top.
pub trait Slotted: SlotEstimator {
    /// Its parameters among the top's.
    fn params(p: &Params) -> &Self::Params;
    /// Its block.
    fn block(top: &TofTop) -> &Self;
    /// Its block, to be stepped.
    fn block_mut(top: &mut TofTop) -> &mut Self;
    /// Its input ports.
    fn wires(inputs: &SlotInputs) -> &Self::In;
}

macro_rules! slotted {
    ($(
        #[doc = $about:literal]
        $Name:ident = $name:literal, $estimator:literal: $module:ident::$Block:ident,
    )+) => {
        $(impl Slotted for crate::firmware::$module::$Block {
            #[inline(always)]
            fn params(p: &Params) -> &Self::Params {
                &p.estimators.$module
            }

            #[inline(always)]
            fn block(top: &TofTop) -> &Self {
                &top.$module
            }

            #[inline(always)]
            fn block_mut(top: &mut TofTop) -> &mut Self {
                &mut top.$module
            }

            #[inline(always)]
            fn wires(inputs: &SlotInputs) -> &crate::firmware::$module::In {
                &inputs.$module
            }
        })+

        /// Input ports of every estimator.
        #[derive(Clone, Copy, Debug)]
        pub struct SlotInputs {
            $($module: crate::firmware::$module::In,)+
        }

        impl TofTop {
            /// Input ports of every estimator as they stand.
            #[inline(always)]
            pub(super) fn slot_inputs(&self) -> SlotInputs {
                SlotInputs { $($module: Wires::$module(self),)+ }
            }
        }
    };
}

firmware_estimators!([slotted]);

impl Params {
    /// From the edge that takes `algo_start` to the one that raises `algo_done`, for the estimator in
    /// use [cycles of clk_sys].
    pub fn estimator_cycles(&self) -> u64 {
        in_slot!(self.estimator, E => E::cycles(E::params(self)))
    }
}

impl TofTop {
    /// The rising edge of `clk_sys` for the estimator in the slot.
    #[inline(always)]
    pub(super) fn estimate(&mut self, p: &Params, inputs: &SlotInputs) {
        self.slot = in_slot!(p.estimator, E => {
            let block = E::block_mut(self);
            block.rise(E::wires(inputs), E::params(p));
            block.outputs()
        });
    }
}
