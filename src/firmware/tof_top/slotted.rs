//! The estimators in the top: their ports, parameters and clock.

use crate::{firmware_estimators, in_slot};

use super::slot::SlotEstimator;
use super::slot_inputs::SlotInputs;
use super::{Params, TofTop, Wires};

/// An estimator of the list: its place in the top.
pub trait Slotted: SlotEstimator {
    /// Its parameters among the top's.
    fn params(p: &Params) -> &Self::Params;
    /// Its block.
    fn block(top: &TofTop) -> &Self;
    /// Its block, to be stepped or set: it no longer counts as resting.
    fn block_mut(top: &mut TofTop) -> &mut Self;
    /// Its input ports as they stand.
    fn ports(top: &TofTop) -> Self::In;
    /// Its input ports among those of all.
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
                (top.rest, top.estimator_changes) = (None, top.estimator_changes + 1);
                &mut top.$module
            }

            #[inline(always)]
            fn ports(top: &TofTop) -> Self::In {
                Wires::$module(top)
            }

            #[inline(always)]
            fn wires(inputs: &SlotInputs) -> &crate::firmware::$module::In {
                &inputs.$module
            }
        })+

        impl TofTop {
            /// Input ports of every estimator as they stand.
            #[inline(always)]
            fn every_slot_input(&self) -> SlotInputs {
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
    /// Input ports of the estimators for the coming edge; none if the one in the slot rests at them.
    #[inline(always)]
    pub(super) fn slot_inputs(&self, p: &Params) -> Option<SlotInputs> {
        let rests = in_slot!(p.estimator, E => {
            self.rest.as_ref().is_some_and(|rest| *E::wires(rest) == E::ports(self))
        });
        (!rests).then(|| self.every_slot_input())
    }

    /// The rising edge of `clk_sys` for the estimator in the slot.
    pub(super) fn estimate(&mut self, p: &Params, inputs: SlotInputs) {
        let rests = in_slot!(p.estimator, E => {
            let (i, p) = (E::wires(&inputs), E::params(p));
            let block = E::block_mut(self);
            block.rise(i, p);
            let rests = block.phase(p).is_none() && block.rests(i, p);
            self.slot = block.outputs();
            rests
        });
        self.rest = rests.then_some(inputs);
    }
}
