//! The converter of a scenario: its chain, what its calibration knows of that, and what the chain does in a run.

use crate::error::{Input, Result};
use crate::firmware::carry_chain::Delays;
use crate::firmware::tdc_decoder::TimeScale;
use crate::firmware::{tdc, tdc_calibration};
use crate::kernel::Time;
use crate::scenario::builtin::Source;
use crate::scenario::drift::{Course, Drifted, conditions};
use crate::scenario::{Scenario, Tdc, calibration, chain, chains};
use crate::sensor::streams::{Source as Noise, stream};
use crate::sim::disturbance::Disturbance;

use super::recalibration;

/// Taps about a transition that may be unsure, for two transitions in the chain to be shown whole.
const MOST_UNSURE: usize = 4;

/// The converter of a scenario, or of a column of its array.
#[derive(Clone, Debug)]
pub(super) struct Converter {
    /// Parameters of `tdc`.
    pub tdc: tdc::Params,
    /// Parameters of `tdc_calibration`, if the firmware calibrates itself.
    pub tdc_calibration: Option<tdc_calibration::Params>,
    /// The delays that the TDC was calibrated by, if they are others at power-up.
    pub calibrated: Option<Delays>,
    /// The converter as its calibration has it, if it is another.
    pub known: Option<tdc::Params>,
    /// Drift of the delays during a run, if there is any.
    pub course: Option<Course>,
    /// Changes of the chain from edge to edge, if there are any.
    pub disturbance: Option<Disturbance>,
}

impl Converter {
    /// For a clock of the period `cycle`; paths of files are taken from `files`.
    ///
    /// # Errors
    /// When a file cannot be read or used, or the chain does not fit the clock or the set-up window.
    pub fn new(scenario: &Scenario, files: &Source, cycle: Time) -> Result<Self> {
        let own = chain::load(&scenario.tdc.profile, files, cycle)?;
        Converter::of_chain(own, scenario, files, cycle)
    }

    /// Of an array's columns, for a clock of the period `cycle`; none if all have the chain of `tdc.profile`.
    ///
    /// # Errors
    /// As [`Converter::new`].
    pub fn of_columns(scenario: &Scenario, files: &Source, cycle: Time) -> Result<Vec<Self>> {
        let chains = chains::load(scenario, files, cycle)?;
        let converter = |own| Converter::of_chain(own, scenario, files, cycle);
        chains.into_iter().map(converter).collect()
    }

    fn of_chain(own: Delays, scenario: &Scenario, files: &Source, cycle: Time) -> Result<Self> {
        let keys = &scenario.tdc;
        let profile = conditions(keys, files)?;
        let chain = Drifted::new(own, keys, profile.as_ref(), cycle)?;
        let scale = time_scale(keys, cycle);
        let known = (chain.known(), keys.decoder);
        let rom = calibration::load(&keys.calibration, files, known, &scale)?;
        let disturbance = disturbance(scenario, &chain)?;
        let tdc = tdc::Params::new(chain.now, scale, keys.coarse_bits, keys.count_stages)
            .with_decoder(keys.decoder)
            .with_calibration(rom.cal);
        let (tdc, tdc_calibration) = recalibration::of(keys, tdc);
        let known = match (rom.chain, &chain.calibrated) {
            // In order, and so that each decoder has the same.
            (Some(chain), _) => Some(tdc.clone().in_order(chain)),
            (None, Some(delays)) => Some(tdc.clone().with_delays(delays.clone())),
            (None, None) => None,
        };
        let (calibrated, course) = (chain.calibrated, chain.course);
        Ok(Converter { tdc, tdc_calibration, calibrated, known, course, disturbance })
    }
}

/// Returns the changes of the chain from edge to edge, if there are any.
///
/// # Errors
/// If more taps may be uncertain than can be represented, or one that is reached at once.
fn disturbance(scenario: &Scenario, chain: &Drifted) -> Result<Option<Disturbance>> {
    let window_ps = scenario.tdc.setup_window_ps;
    let window = Time::from_ps_f64(window_ps);
    if window == Time::ZERO && chain.course.is_none() {
        return Ok(None);
    }
    let arrivals = chain.now.arrivals();
    let narrowest = arrivals.windows(MOST_UNSURE + 1).map(|taps| taps[MOST_UNSURE] - taps[0]).min();
    let most = narrowest.unwrap_or(Time::NEVER).min(Time::from_fs(2 * arrivals[0].fs()));
    if window >= most {
        let expected = format!(
            "expected less than {} ps: no more than {MOST_UNSURE} taps of this chain within it, and none that a \
             hit reaches sooner than half of it",
            most.fs() as f64 / 1e3
        );
        return Err(Input::new("scenario", expected)
            .field("tdc.setup_window_ps")
            .value(window_ps)
            .into());
    }
    let pace = chain.course.as_ref().map_or_else(Default::default, |course| course.pace.clone());
    let words = stream(scenario.seed, Noise::SetupWindow, 0);
    Ok(Some(Disturbance::new(window, words, pace)))
}

fn time_scale(tdc: &Tdc, cycle: Time) -> TimeScale {
    let [bin, first] = [tdc.bin_ps, tdc.first_bin_ps].map(Time::from_ps_f64);
    TimeScale::new(cycle, bin, first, tdc.coarse_bits, tdc.bins as usize)
}
