//! Columns of a sweep's table: the quantities that a point can yield, by name.

use serde::Serialize;

use tofsim::error::{Result, hint};
use tofsim::files::toml::Checked;
use tofsim::optics::first_photon::FirstPhoton;
use tofsim::optics::{Chances, Hazard};
use tofsim::sim::setup::Setup;
use tofsim_learn::error_budget::Bound;
use tofsim_learn::estimation::EstimatorKind;

use crate::errors::Errors;
use crate::figure::Figure;
use crate::images::Images;
use crate::plan::file::Fidelity;
use crate::tally::Tally;

/// A column.
#[derive(Clone, Debug, Serialize)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Meaning, as a phrase.
    pub meaning: &'static str,
    /// Origin of its values.
    #[serde(skip)]
    pub quantity: Quantity,
}

/// Origin of a column's values.
#[derive(Clone, Copy, Debug)]
pub enum Quantity {
    /// Expected value from the scenario, without a simulation.
    Expected(fn(&Setup) -> Result<Option<f64>>),
    /// Hits of the simulated frames.
    Hits(fn(&Tally) -> Figure),
    /// Duration of a frame, which is not random.
    Duration(fn(&Tally) -> f64),
    /// Errors of the estimator with the given index.
    Errors(usize, fn(&Errors) -> Figure),
    /// What the images of an array can be expected to have, which is not random.
    ExpectedOfImages(fn(&Images) -> Figure),
    /// Simulated images of an array.
    OfImages(fn(&Images) -> Figure),
}

impl Column {
    /// Returns whether the values are random, and therefore have standard errors.
    pub fn is_random(&self) -> bool {
        matches!(self.quantity, Quantity::Hits(_) | Quantity::Errors(..) | Quantity::OfImages(_))
    }
}

/// Definition of a column of [`Quantity::Expected`]: name, unit, meaning, function.
type Expected = (&'static str, &'static str, &'static str, fn(&Setup) -> Result<Option<f64>>);

/// Columns of expected values.
const EXPECTED: &[Expected] = &[
    ("signal_per_shot", "1", "Detected laser photons of a shot, S_p of eq. 3.14", |setup| {
        Ok(Some(setup.budget.signal_per_shot))
    }),
    ("ambient_rate_hz", "1/s", "Rate of avalanches by ambient light, N_r of eq. 3.20", |setup| {
        Ok(Some(setup.budget.ambient_rate_hz))
    }),
    ("dark_rate_hz", "1/s", "Rate of avalanches in the dark", |setup| {
        Ok(Some(setup.budget.dark_rate_hz))
    }),
    ("hit_probability", "1", "Chance that a shot has a hit", |setup| {
        Ok(setup.chances().map(|chances| chances.hit))
    }),
    ("signal_first_probability", "1", "Chance that a laser photon is a shot's hit", |setup| {
        Ok(setup.chances().map(|chances| chances.signal_first))
    }),
    (
        "signal_to_noise",
        "1",
        "Hits of laser photons to one of any other cause, in the histogram",
        |setup| Ok(setup.chances().as_ref().and_then(Chances::signal_to_noise)),
    ),
    ("pulse_energy_j", "J", "Energy of a laser pulse", |setup| {
        Ok(Some(setup.budget.pulse_energy_j))
    }),
    (
        "average_power_w",
        "W",
        "Average power of the laser at the firmware's rate; the key laser.average_power_w is that at laser.repetition_rate_hz",
        |setup| Ok(Some(setup.exposure_to_a_frame().average_w)),
    ),
    ("eye_safety_limit_w", "W", "Class 1 limit for an eye that sees a frame (eq. 3.3)", |setup| {
        Ok(setup.exposure_to_a_frame().limit_w)
    }),
    (
        "eye_safety_margin",
        "1",
        "That limit to the average power, or that of the pulses to their energy if it is less: from 1 on it is Class 1",
        |setup| Ok(margin(setup)),
    ),
    (
        "eye_safety_margin_at_stated_rate",
        "1",
        "The same of the average power alone, at the rate at which the laser's power is stated, as in the thesis",
        |setup| Ok(setup.exposure_at_the_optics_rate().margin()),
    ),
    (
        "cramer_rao_two_sd_mm",
        "mm",
        "Twice the standard deviation that no unbiased estimate of one frame is below",
        |setup| Ok(Bound::of(setup)?.two_sd_mm),
    ),
    (
        "first_photon_chance",
        "1",
        "Chance that a shot's first avalanche comes around the echo, by the first-photon model",
        |setup| Ok(first_photon(setup).map(|first| first.chance)),
    ),
    (
        "first_photon_peak_shift_mm",
        "mm",
        "Shift of the histogram's peak by pile-up, by the first-photon model",
        |setup| Ok(first_photon(setup).map(|first| FirstPhoton::shift_mm(first.peak_ps))),
    ),
    (
        "first_photon_shift_mm",
        "mm",
        "Shift of the mean of hits around the echo, by the same; `echo_shift_mm` is what frames have",
        |setup| Ok(first_photon(setup).map(|first| FirstPhoton::shift_mm(first.mean_ps))),
    ),
    ("range_m", "m", "Distance whose echo comes with the end of the last bin", |setup| {
        Ok(range_m(setup))
    }),
    ("second_per_shot", "1", "Detected laser photons of a shot from the second surface", |setup| {
        Ok(Some(setup.budget.second_per_shot))
    }),
    ("cover_per_shot", "1", "Detected laser photons of a shot from the cover window", |setup| {
        Ok(Some(setup.budget.cover_per_shot))
    }),
];

/// Columns of simulated frames: name, unit, meaning, origin.
const OF_FRAMES: &[(&str, &str, &str, Quantity)] = &[
    (
        "hits_per_frame",
        "hits",
        "Hits in a frame's histogram",
        Quantity::Hits(|tally| tally.hits.mean()),
    ),
    (
        "tdc_hits_per_frame",
        "hits",
        "Hits that the TDC keeps in a frame, with a code or without",
        Quantity::Hits(|tally| tally.tdc_hits.mean()),
    ),
    (
        "echo_shift_mm",
        "mm",
        "Mean of a frame's hits around the echo, from where it is",
        Quantity::Hits(|tally| tally.echo.mean()),
    ),
    (
        "estimator_cycles",
        "cycles of clk_sys",
        "From algo_start to algo_done",
        Quantity::Duration(|tally| tally.estimator_cycles),
    ),
    (
        "frame_cycles",
        "cycles of clk_sys",
        "From Clear to algo_done",
        Quantity::Duration(|tally| tally.frame_cycles),
    ),
    ("frame_ms", "ms", "The same in time", Quantity::Duration(|tally| tally.frame_ms)),
];

/// Definition of a column of [`Quantity::Errors`]: name after the estimator's, unit, meaning, function.
type OfErrors = (&'static str, &'static str, &'static str, fn(&Errors) -> Figure);

/// Columns of an estimator.
const OF_ERRORS: &[OfErrors] = &[
    ("bias_mm", "mm", "Mean error of the depths, b of eq. 4.1", Errors::bias),
    ("sd_mm", "mm", "Standard deviation of the depths, sigma of eq. 4.1", Errors::sd),
    ("two_sd_mm", "mm", "Twice that", Errors::two_sd),
    ("root_mse_mm", "mm", "Root of the mean squared error, eq. 4.2", Errors::root_mse),
    ("failure_rate", "1", "Part of the frames without a depth", Errors::failure_rate),
    ("outlier_rate", "1", "Part of the depths that are far off, or negative", Errors::outlier_rate),
];

/// Columns of an array's images, of its firmware's estimator: name, unit, meaning, origin.
const OF_IMAGES: &[(&str, &str, &str, Quantity)] = &[
    (
        "images_per_s",
        "1/s",
        "Image rate of the firmware that scans the array",
        Quantity::ExpectedOfImages(Images::rate),
    ),
    (
        "signal_hits",
        "hits",
        "Hits of laser photons that a pixel can expect in a frame, median of the pixels",
        Quantity::ExpectedOfImages(|images| images.expected(|pixel| pixel.expected.signal_hits)),
    ),
    (
        "ambient_hits",
        "hits",
        "Other hits that a pixel can expect in a frame, median of the pixels",
        Quantity::ExpectedOfImages(|images| images.expected(|pixel| pixel.expected.ambient_hits)),
    ),
    (
        "fill_rate",
        "1",
        "Part of the pixels with a valid depth",
        Quantity::OfImages(Images::fill_rate),
    ),
    (
        "flying_rate",
        "1",
        "Part of the valid depths between fore- and background: farther than an outlier from the least and the largest true depth of pixel and neighbours",
        Quantity::OfImages(Images::flying_rate),
    ),
    (
        "root_mse_mm",
        "mm",
        "Root of the mean squared error of the valid depths",
        Quantity::OfImages(Images::root_mse),
    ),
    (
        "bias_by_pixel_mm",
        "mm",
        "Root mean square over the pixels of their mean error, without what noise contributes; takes two images",
        Quantity::OfImages(Images::bias_by_pixel),
    ),
    (
        "sd_by_pixel_mm",
        "mm",
        "Root mean square over the pixels of the standard deviation of their depths; takes two images",
        Quantity::OfImages(Images::sd_by_pixel),
    ),
    (
        "median_sigma_mm",
        "mm",
        "Median standard deviation that the estimator states of a valid depth",
        Quantity::OfImages(Images::median_sigma),
    ),
    (
        "error_over_sigma",
        "1",
        "Root mean square of errors over the standard deviations that the estimator states",
        Quantity::OfImages(Images::error_over_sigma),
    ),
];

/// Returns all columns of an array's images.
pub fn of_images() -> Vec<Column> {
    let column = |&(name, unit, meaning, quantity): &(&str, _, _, _)| {
        let name = name.to_owned();
        Column { name, unit, meaning, quantity }
    };
    OF_IMAGES.iter().map(column).collect()
}

/// Returns all columns of a fidelity and some estimators.
pub fn all(fidelity: Fidelity, estimators: &[EstimatorKind]) -> Vec<Column> {
    let expected = EXPECTED.iter().map(|&(name, unit, meaning, of)| {
        let (name, quantity) = (name.to_owned(), Quantity::Expected(of));
        Column { name, unit, meaning, quantity }
    });
    let of_frames = OF_FRAMES.iter().map(|&(name, unit, meaning, quantity)| {
        let name = name.to_owned();
        Column { name, unit, meaning, quantity }
    });
    let of_errors = estimators.iter().enumerate().flat_map(|(place, kind)| {
        OF_ERRORS.iter().map(move |&(name, unit, meaning, of)| {
            let (name, quantity) = (format!("{}.{name}", kind.name()), Quantity::Errors(place, of));
            Column { name, unit, meaning, quantity }
        })
    });
    match fidelity {
        Fidelity::Budget => expected.collect(),
        _ => expected.chain(of_frames).chain(of_errors).collect(),
    }
}

/// Selects the columns that a plan requests, in the order of `known`; all if it requests none.
///
/// # Errors
/// If a requested column does not exist.
pub fn chosen(checked: &Checked, asked: &[String], known: &[Column]) -> Result<Vec<Column>> {
    if asked.is_empty() {
        return Ok(known.to_vec());
    }
    let mut is_asked = vec![false; known.len()];
    for (place, pattern) in asked.iter().enumerate() {
        let key = format!("outputs.{place}");
        let glob = globset::Glob::new(pattern);
        let glob = glob.map_err(|error| checked.fault(&key, error))?.compile_matcher();
        let mut found = false;
        for (is_asked, column) in is_asked.iter_mut().zip(known) {
            let matches = glob.is_match(&column.name);
            *is_asked |= matches;
            found |= matches;
        }
        if !found {
            let (hint, known) = hint(pattern, known.iter().map(|column| column.name.as_str()));
            let expected = format!("no such column{hint}; expected one of {known}");
            return Err(checked.fault(&key, expected).into());
        }
    }
    let chosen = known.iter().zip(is_asked).filter(|(_, is_asked)| *is_asked);
    Ok(chosen.map(|(column, _)| column.clone()).collect())
}

/// Returns the smaller ratio of limit to exposure, of the average power and of the pulses of a frame.
fn margin(setup: &Setup) -> Option<f64> {
    let frame = setup.exposure_to_a_frame();
    Some(frame.margin()?.min(setup.pulse_train(&frame).margin()?))
}

/// Returns the distance of an echo at the end of the histogram.
fn range_m(setup: &Setup) -> Option<f64> {
    use tofsim::optics::budget::LIGHT_M_S;
    let end = setup.bins().spans().iter().map(|span| span.until).max()?;
    (end > setup.budget.delay).then(|| (end - setup.budget.delay).seconds() * LIGHT_M_S / 2.0)
}

/// Returns the distribution of first avalanches around the echo, if shots are independent.
fn first_photon(setup: &Setup) -> Option<FirstPhoton> {
    setup.chances()?;
    FirstPhoton::new(&setup.budget, &Hazard::new(&setup.budget))
}
