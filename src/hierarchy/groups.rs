//! Where the signals' values are in the firmware, and when they may change.

use crate::firmware::{TofTop, vcsel_driver};
use crate::kernel::signals::{Signal, Signals, Sink};

use super::instants::Instant;
use super::part::ram_changes;

/// The groups of signals that hold values, in the order of their ids: the instants at which they
/// may change, scope below the top, path of the field in [`TofTop`], type.
macro_rules! groups {
    ($($instant:ident $scope:literal => $root:ident $(. $field:ident)*: $ty:ty;)*) => {
        pub(super) fn groups() -> Vec<(&'static str, &'static str, Vec<Signal>)> {
            vec![$((
                $scope,
                concat!(stringify!($root) $(, ".", stringify!($field))*),
                <$ty as Signals>::list(),
            ),)*]
        }

        /// First id of the RAM's words, after those of all groups.
        pub(super) const RAM: usize = 0 $(+ <$ty as Signals>::COUNT)*;

        /// Reports every signal that differs from `before`, or every one.
        pub fn changes(top: &TofTop, before: Option<&TofTop>, sink: &mut impl Sink) {
            let _id = 0;
            $(
                let (now, then) = (&top.$root $(.$field)*, before.map(|b| &b.$root $(.$field)*));
                if then != Some(now) {
                    now.changes(then, _id, sink);
                }
                let _id = _id + <$ty as Signals>::COUNT;
            )*
            ram_changes(top, before, sink);
        }

        /// Reports every signal that differs from `kept` in those groups, a bit for each, and keeps
        /// it there; of the groups only those that may change at an [`Instant`] of that number.
        #[inline]
        pub(super) fn follow<const INSTANT: u8>(
            top: &TofTop,
            groups: u32,
            kept: &mut TofTop,
            sink: &mut impl Sink,
        ) {
            let (_id, _group) = (0, 1);
            $(
                if Instant::$instant as u8 <= INSTANT && groups & _group != 0 {
                    let (now, then) = (&top.$root $(.$field)*, &mut kept.$root $(.$field)*);
                    if then != now {
                        now.changes(Some(&*then), _id, sink);
                        *then = *now;
                    }
                }
                let (_id, _group) = (_id + <$ty as Signals>::COUNT, _group << 1);
            )*
        }

        /// Makes all that [`changes`] looks at in `to` what it is in `from`, without allocating.
        pub fn copy(from: &TofTop, to: &mut TofTop) {
            $(to.$root $(.$field)* = from.$root $(.$field)*;)*
            to.histogram_builder.ram.copy_from_slice(&from.histogram_builder.ram[..]);
        }
    };
}

groups! {
    Between "" => clocks: crate::firmware::tof_top::Clocks;
    Between "" => pins: crate::firmware::tof_top::Pins;
    Fall250 "" => nets: crate::firmware::tof_top::Nets;
    Between "pll" => pll: crate::firmware::pll::Out;
    Rise125 "reset_sync_125" => reset_sync_125: crate::firmware::reset_sync::ResetSync;
    Rise250 "reset_sync_250" => reset_sync_250: crate::firmware::reset_sync::ResetSync;
    Rise125 "control_sync" => control_sync: crate::firmware::control_sync::ControlSync;
    Rise125 "frame_ctrl" => frame_ctrl: crate::firmware::frame_ctrl::FrameCtrl;
    Rise125 "vcsel_driver" => vcsel_driver.registers: vcsel_driver::Registers;
    Rise250 "vcsel_driver" => vcsel_driver.registers_250: vcsel_driver::Registers250;
    Fall250 "vcsel_driver.ddr_output" =>
        vcsel_driver.ddr_output: crate::firmware::ddr_output::DdrOutput;
    Fall250 "lvds_output" => lvds_output: crate::firmware::lvds_output::Out;
    Rise125 "spad_control" => spad_control: crate::firmware::spad_control::SpadControl;
    Rise125 "tdc.carry_chain" => tdc.carry_chain: crate::firmware::carry_chain::CarryChain;
    Rise125 "tdc.coarse_counter" =>
        tdc.coarse_counter: crate::firmware::coarse_counter::CoarseCounter;
    Rise125 "tdc.tdc_latch" => tdc.tdc_latch: crate::firmware::tdc_latch::TdcLatch;
    Rise125 "tdc.tdc_decoder" => tdc.tdc_decoder: crate::firmware::tdc_decoder::TdcDecoder;
    Rise125 "code_preload" => code_preload: crate::firmware::code_preload::CodePreload;
    Rise125 "depth_estimator.estimator_ctrl" =>
        depth_estimator.estimator_ctrl: crate::firmware::estimator_ctrl::EstimatorCtrl;
    Rise125 "depth_estimator.forward1" =>
        depth_estimator.forward1: crate::firmware::forward1::Forward1;
    Rise125 "depth_estimator.tansig" => depth_estimator.tansig: crate::firmware::tansig::Tansig;
    Rise125 "depth_estimator.forward2" =>
        depth_estimator.forward2: crate::firmware::forward2::Forward2;
    Rise125 "centroid_estimator" =>
        centroid_estimator.registers: crate::firmware::centroid_estimator::Registers;
}
