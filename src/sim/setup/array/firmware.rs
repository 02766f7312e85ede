//! The firmware that scans an array.

use std::fmt::Display;
use std::sync::Arc;

use crate::error::{Input, Result};
use crate::firmware::frame_ctrl::timing::RowTiming;
use crate::firmware::likelihood_estimator;
use crate::firmware::tdc_decoder::Decoder;
use crate::firmware::tof_top::{CodeSource, HistogramSource, Params};
use crate::kernel::Time;
use crate::kernel::scan::{MOST_ROWS, Scan};

use crate::scenario::window::Window;
use crate::sim::setup::Setup;

use super::ArraySetup;

impl ArraySetup {
    /// Returns the parameters of the firmware that scans the array.
    ///
    /// # Errors
    /// When it has more rows than `spad_sel` selects, or the scenario has what a firmware of several pixels has not.
    pub fn firmware(&self) -> Result<Params> {
        let setup = self.common();
        let fault = |field: &str, value: &dyn Display, expected: &str| {
            Input::new(format!("scenario {}", setup.name), expected)
                .field(field)
                .value(value)
                .into()
        };
        let [rows, columns] = self.size().map(|count| count as u32);
        if rows > MOST_ROWS {
            let expected = "expected at most 40 for the firmware: spad_sel has 40 bits";
            return Err(fault("array.rows", &rows, expected));
        }
        let scan = Scan { rows, columns, banks: setup.scenario.array.banks };
        let mut params = setup.params.clone();
        if !scan.is_single() {
            if let HistogramSource::Preload(_) = params.histogram_source {
                return Err(fault("stimulus.histogram", &"set", "expected none with an array"));
            }
            if let CodeSource::Preload(_) = params.code_source {
                return Err(fault("stimulus.codes", &"set", "expected none with an array"));
            }
            if params.tdc_calibration.is_some() {
                let frames = setup.scenario.tdc.recalibrate_frames;
                let expected = "expected 0 with an array: its TDCs take their ages from a ROM";
                return Err(fault("tdc.recalibrate_frames", &frames, expected));
            }
        }
        params.frame_ctrl.scan = scan;
        if let [first, others @ ..] = &setup.pixel_files.columns[..] {
            if params.tdc.decoder.encoder.decoder() == Decoder::Reordered {
                let expected = "expected ones or leading with array.chains_file: the order of the taps is that of one chain";
                return Err(fault("tdc.decoder", &Decoder::Reordered.name(), expected));
            }
            if let Some(name) = &setup.scenario.estimator.glass_file {
                let expected =
                    "expected none with array.chains_file: a template is for the bins of one chain";
                return Err(fault("estimator.glass_file", name, expected));
            }
            params.tdc = first.converter.tdc.clone();
            params.channels = others.iter().map(|other| other.converter.tdc.clone()).collect();
            let edges: Option<Vec<_>> =
                setup.pixel_files.columns.iter().map(|column| column.edges.clone()).collect();
            // A column that the estimator is not for leaves its stand-in, which nothing starts.
            if let Some([edges, columns @ ..]) = edges.as_deref() {
                let estimator = &mut params.estimators.likelihood_estimator;
                let own = (**estimator).clone().with_edges(Arc::clone(edges));
                let columns = columns.into();
                *estimator = Arc::new(likelihood_estimator::params::Params { columns, ..own });
            }
        }
        Ok(params)
    }

    /// Returns the part that all pixels have in common, with that firmware.
    ///
    /// # Errors
    /// As [`ArraySetup::firmware`].
    pub fn with_firmware(&self) -> Result<Setup> {
        Ok(Setup { params: self.firmware()?, ..self.common().clone() })
    }

    /// Returns the windows of the waveform of so many images: those given, or the scenario's, or a first look. Shots are
    /// those of all rows.
    ///
    /// # Errors
    /// As [`ArraySetup::firmware`], and when a window lies past the end of the run.
    pub fn windows(&self, given: &[Window], images: u64) -> Result<Vec<Window>> {
        let (common, timing, [rows, _]) = (self.common(), self.timing()?, self.size());
        let cycles = images.saturating_mul(timing.image).saturating_add(timing.latency);
        let longest = Time::NEVER.fs() / common.cycle().fs();
        let end = common.pll().clk_sys.rise(cycles.min(longest));
        common.windows_within(given, common.shots(images.saturating_mul(rows as u64)), end)
    }

    /// Returns how long rows and images take.
    ///
    /// # Errors
    /// As [`ArraySetup::firmware`].
    pub fn timing(&self) -> Result<RowTiming> {
        let (params, setup) = (self.firmware()?, self.common());
        Ok(params.frame_ctrl.timing(setup.laser_period(), params.estimator_cycles()))
    }
}
