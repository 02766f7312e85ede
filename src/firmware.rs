//! The FPGA firmware: one file per module, the same stems as `rtl_ref/*.v`, and the list of its estimators.

pub mod carry_chain;
pub mod centroid_estimator;
pub mod coarse_counter;
pub mod code_preload;
pub mod control_sync;
pub mod ddr_output;
pub mod depth_estimator;
pub mod estimator_ctrl;
pub mod forward1;
pub mod forward2;
pub mod frame_ctrl;
pub mod histogram_builder;
pub mod histogram_preload;
pub mod laser_guard;
pub mod likelihood_estimator;
pub mod likelihood_glass;
pub mod likelihood_memory;
pub mod likelihood_pair;
pub mod likelihood_scan;
pub mod likelihood_solver;
pub mod likelihood_sums;
pub mod likelihood_terms;
pub mod lvds_output;
pub mod pll;
pub mod registers;
pub mod reset_sync;
pub mod spad_control;
pub mod tansig;
pub mod tdc;
pub mod tdc_calibration;
pub mod tdc_decoder;
pub mod tdc_latch;
pub mod tof_top;
pub mod uart_bridge;
pub mod vcsel_driver;

/// Calls a macro with the list of the firmware's estimators, after what is given to it: meaning, variant, name in a
/// scenario, name on the command line, module and block of each. The Verilog parameter `Estimator` counts them from 0.
#[macro_export]
macro_rules! firmware_estimators {
    ([$($callback:tt)+] $($($given:tt)+)?) => {
        $($callback)+! {
            $($($given)+;)?
            /// The neural network in fixed point
            Network = "network", "network": depth_estimator::DepthEstimator,
            /// Argmax with centroid correction
            Centroid = "centroid", "centroid": centroid_estimator::CentroidEstimator,
            /// Maximum likelihood in integers
            LikelihoodEstimator = "likelihood", "likelihood_estimator":
                likelihood_estimator::LikelihoodEstimator,
        }
    };
}
