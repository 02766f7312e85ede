//! The network in floating and in fixed point over the thesis's test grid, and over ten patterns a distance.

use std::sync::atomic::AtomicBool;

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{Axis, Grid, HistogramSource, Rows, Subset};
use tofsim_learn::estimation::{Estimator, EstimatorInputs, EstimatorKind};
use tofsim_learn::evaluation::{Evaluation, Figures, spread::OUTLIER_M};

/// Histograms of the test grid where there are to be few.
const QUICK_ROWS: u64 = 12_240;
/// Patterns at a distance (section 6.7.4).
pub const PATTERNS: u64 = 10;

/// Errors over the test grid, and over ten patterns at each of six distances.
pub struct Networks {
    /// Before rounding.
    pub float: Figures,
    /// As the firmware computes it.
    pub fixed: Figures,
    /// The same of ten patterns at a distance.
    pub patterns: Figures,
    /// Histograms of the test grid.
    pub rows: u64,
    /// Histograms at each of its distances.
    pub rows_at_a_distance: u64,
    /// Parts of the errors, less the median of their distance, within what the specification allows, before and
    /// after rounding [1].
    pub within: [f64; 2],
}

impl Networks {
    pub(super) fn measure(setup: &Setup, quick: bool, stop: Option<&AtomicBool>) -> Result<Self> {
        let source = HistogramSource::new(setup)?;
        let seed = setup.scenario.seed;
        let test = Grid::test();
        let all = match quick {
            true => Rows::Subset(Subset::new(test.clone(), QUICK_ROWS, seed)),
            false => Rows::All(test.clone()),
        };
        let six = Axis::parse("grid", "target.distance_m=0.1..0.6:0.1")?;
        let distances = six.count();
        let six = Grid { distances_m: six, ..test };
        // Another seed than that of the rows before: other lights.
        let patterns = Subset::new(six, PATTERNS * distances, seed ^ PATTERNS);
        let measure = |rows: &Rows, seed| -> Result<Evaluation> {
            let estimators = estimators(setup, &source)?;
            Evaluation::new(&source, rows, seed, &estimators, stop, |_| {})
        };
        let evaluation = measure(&all, seed)?;
        let patterns = measure(&Rows::Subset(patterns), seed ^ PATTERNS)?;
        let figures = |of: &Evaluation, k: usize| Figures::new(of, &of.columns[k], OUTLIER_M);
        let (float, fixed) = (figures(&evaluation, 0), figures(&evaluation, 1));
        let within = [0, 1].map(|k| within(&evaluation, k, [&float, &fixed][k]));
        Ok(Networks {
            patterns: figures(&patterns, 1),
            rows: all.count(),
            rows_at_a_distance: all.count() / float.by_distance_m.len().max(1) as u64,
            float,
            fixed,
            within,
        })
    }
}

fn estimators<'a>(
    setup: &'a Setup,
    source: &'a HistogramSource,
) -> Result<Vec<Box<dyn Estimator + 'a>>> {
    let needs =
        EstimatorInputs { acquisition: source.acquisition(0), network: &setup.network, setup };
    let kinds = [EstimatorKind::NetworkFloat, EstimatorKind::Network];
    let estimators = kinds.into_iter().map(|kind| kind.estimator(&needs));
    Ok(estimators.collect::<std::result::Result<Vec<_>, Input>>()?)
}

/// Part of the errors that are within the specification, each less the median of its distance (section 5.4.2).
fn within(evaluation: &Evaluation, column: usize, figures: &Figures) -> f64 {
    let errors = evaluation.scenes.iter().zip(&evaluation.columns[column].errors_m);
    let is_within = |(scene, error): &(&tofsim_learn::dataset::Scene, &Option<f64>)| {
        let quartiles = figures.at(scene.distance_m).and_then(|spread| spread.quartiles_mm);
        let allowed_mm = tofsim_learn::evaluation::thesis::allowed_error_mm(scene.distance_m);
        let off_mm = error.zip(quartiles).map(|(error, quartiles)| 1e3 * error - quartiles[2]);
        off_mm.is_some_and(|off_mm| off_mm.abs() <= allowed_mm)
    };
    let count = errors.clone().count().max(1) as f64;
    errors.filter(is_within).count() as f64 / count
}
