//! Measurements of the items that are no sweep, one file for each subject.

mod estimator;
mod fixed_point;
mod histograms;
mod laser;
mod network;
mod oscilloscope;
mod parameters;
mod peak;
mod subtraction;

use tofsim::error::Result;

use super::study::Study;
use super::values::Measured;

/// A measurement.
pub type Measure = fn(&Study) -> Result<Measured>;

/// The measurement of each item that has one.
const MEASURES: [(&str, Measure); 36] = [
    ("eq-3.3", parameters::eye_safety),
    ("table-3.1", parameters::emission_limits),
    ("table-3.2", parameters::specifications),
    ("fig-3.3", histograms::model),
    ("table-4.3", peak::failures),
    ("fig-4.1", histograms::peak_shift),
    ("listing-5.3", peak::compensation),
    ("table-5.1", parameters::findpeaks),
    ("table-5.2", peak::errors),
    ("table-5.3", parameters::grids),
    ("table-5.4", parameters::training),
    ("table-5.5", network::floating_point),
    ("fig-5.1", histograms::by_cause),
    ("fig-5.3", peak::failed_histogram),
    ("fig-5.4", peak::examples),
    ("fig-5.5", subtraction::subtraction),
    ("fig-5.7a", network::depths),
    ("fig-5.7b", network::floating_point),
    ("clocks", estimator::clocks),
    ("table-6.1", laser::rates),
    ("table-6.2", laser::modes),
    ("table-6.3", laser::delay_cells),
    ("table-6.4", fixed_point::formats),
    ("table-6.5", network::hardware),
    ("fig-6.3", laser::rates),
    ("fig-6.6", laser::trigger),
    ("fig-6.7", oscilloscope::screen),
    ("fig-6.9", laser::timing),
    ("fig-6.12", estimator::preload),
    ("fig-6.13", estimator::words),
    ("fig-6.14", estimator::printed),
    ("fig-6.16a", fixed_point::weights),
    ("fig-6.16b", fixed_point::activation),
    ("fig-6.17", network::both),
    ("fig-6.19", estimator::steps),
    ("fig-6.21", estimator::depth_word),
];

/// Returns the measurement of an item, if it has one.
pub fn measure(id: &str) -> Option<Measure> {
    MEASURES.iter().find(|(known, _)| *known == id).map(|(_, measure)| *measure)
}

#[cfg(test)]
mod tests {
    use super::super::table::items;
    use super::*;

    #[test]
    fn every_measurement_is_of_an_item() {
        let items = items().unwrap();
        for (id, _) in MEASURES {
            assert!(items.iter().any(|item| item.id == id), "{id}");
        }
    }
}
