//! Pins, wires and parameters of the top.

use crate::firmware::histogram_builder::{self, Bin, Count};
use crate::firmware::vcsel_driver::{self, Rate};
use crate::firmware::{control_sync, frame_ctrl, histogram_preload, tdc, tdc_calibration};
use crate::kernel::U;
use crate::signals;

use super::estimator_params::EstimatorParams;
use super::estimators::FirmwareEstimator;

signals! {
    /// Input pins beside the clock.
    pub struct Pins {
        /// Reset button of the board, asynchronous.
        pub rst: bool,
        /// Output of the selected row's SPAD in column 0, asynchronous.
        pub tdc_stop: bool,
        /// Outputs of the others, from column 1 on, asynchronous.
        #[only_if(Scanned)]
        #[size(LastColumn)]
        pub column_stop: U<63>,
        /// SPAD quench mode (Table 6.2), asynchronous.
        pub mode: bool,
        /// Laser repetition rate (Table 6.1), asynchronous.
        #[size(RateBits)]
        pub laser_freq: Rate,
        /// Lets the laser fire, asynchronous.
        pub laser_en: bool,
        /// Lets the estimator start, asynchronous.
        pub dsp_en: bool,
        /// Abandons the frame, asynchronous.
        pub dsp_rst: bool,
        /// From the host, asynchronous.
        #[only_if(Hosted)]
        pub uart_rx: bool = true,
        /// The interlock is open, asynchronous.
        #[only_if(Hosted)]
        pub interlock: bool,
        /// The control pins are in force, and not the registers, asynchronous.
        #[only_if(Hosted)]
        pub select_pins: bool,
    }
}

signals! {
    /// Levels of the clocks; kept for waveforms, the simulation steps by edges.
    pub struct Clocks {
        /// Oscillator of the board.
        pub clk_in: bool,
        /// PLL output.
        pub clk_sys: bool,
        /// PLL output.
        pub clk_laser: bool,
    }
}

signals! {
    /// Wires of the top that are no register of a module.
    pub struct Nets {
        /// Reset of the TDC and the estimator: the board's or the acquisition computer's.
        pub rst_dsp: bool = true,
        /// Code of a hit, from the source in use [bins].
        #[size(BinBits)]
        pub tdc_code: Bin,
        /// `tdc_code` is new.
        pub tdc_valid: bool,
        /// Word of the histogram, from the source in use [hits].
        #[size(CountBits)]
        pub count: Count,
        /// Single-ended laser pulse.
        pub laser_on: bool,
    }
}

/// Source of codes.
#[derive(Clone, Debug)]
pub enum CodeSource {
    /// The TDC.
    Tdc,
    /// A ROM, one code a shot (thesis 6.6.1).
    Preload(Box<[Bin]>),
}

/// Source of the estimator's histogram.
#[derive(Clone, Debug)]
pub enum HistogramSource {
    /// The histogram builder.
    Builder,
    /// A ROM (thesis 6.7.4).
    Preload(Box<histogram_preload::Rom>),
}

/// Parameters that elaboration fixes.
#[derive(Clone, Debug)]
pub struct Params {
    /// Size of the histogram.
    pub histogram: histogram_builder::Params,
    /// Frame length.
    pub frame_ctrl: frame_ctrl::Params,
    /// Laser periods and pulse.
    pub vcsel_driver: vcsel_driver::Params,
    /// Delay chain and its ROM.
    pub tdc: tdc::Params,
    /// Those of the other columns of an array, if each has its own.
    pub channels: Vec<tdc::Params>,
    /// Parameters of its calibration, if it has one.
    pub tdc_calibration: Option<tdc_calibration::Params>,
    /// Parameters of the estimators.
    pub estimators: EstimatorParams,
    /// Estimator in the estimator slot.
    pub estimator: FirmwareEstimator,
    /// Source of codes.
    pub code_source: CodeSource,
    /// Source of the estimator's histogram.
    pub histogram_source: HistogramSource,
    /// Whether a host controls the firmware through registers. A run has none: its control signals come from pins.
    pub is_hosted: bool,
}

/// Modules between the host and the firmware.
const OF_HOST: [&str; 3] = ["uart_bridge", "registers", "laser_guard"];

impl Params {
    /// Returns the delay chain and the ROM of a column of an array.
    #[inline]
    pub fn tdc_of(&self, column: usize) -> &tdc::Params {
        column.checked_sub(1).and_then(|other| self.channels.get(other)).unwrap_or(&self.tdc)
    }

    /// Parameters of `control_sync`.
    #[inline(always)]
    pub fn control_sync(&self) -> control_sync::Params {
        control_sync::Params { is_hosted: self.is_hosted }
    }

    /// Modules of the top that are left out: stand-ins, or what they stand in for.
    pub fn left_out(&self) -> Vec<&'static str> {
        let others = FirmwareEstimator::ALL.iter().copied();
        let others = others.filter(|other| *other != self.estimator);
        let sources = [
            match self.code_source {
                CodeSource::Tdc => "code_preload",
                CodeSource::Preload(_) => "tdc",
            },
            match self.histogram_source {
                HistogramSource::Builder => "histogram_preload",
                HistogramSource::Preload(_) => "histogram_builder",
            },
        ];
        let calibration = self.tdc_calibration.is_none().then_some("tdc_calibration");
        let bank = (self.frame_ctrl.scan.banks == 1).then_some("second_bank");
        let glass = (self.estimators.likelihood_estimator.glass.bins() == 0)
            .then_some("likelihood_estimator.likelihood_glass");
        let pair = (!self.estimators.likelihood_estimator.has_second())
            .then_some("likelihood_estimator.likelihood_pair");
        let host = OF_HOST.into_iter().filter(|_| !self.is_hosted);
        sources
            .into_iter()
            .chain(calibration)
            .chain(bank)
            .chain(glass)
            .chain(pair)
            .chain(host)
            .chain(others.map(FirmwareEstimator::module))
            .collect()
    }
}
