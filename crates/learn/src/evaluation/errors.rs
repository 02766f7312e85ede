//! The errors of estimators, histogram by histogram.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use tofsim::error::{Result, poll_stop};
use tofsim::firmware::likelihood_estimator::targets::Targets;
use tofsim::network::Histogram;
use tofsim::sim::setup::truth::TrueDepths;

use crate::dataset::blocks::{Last, Sample};
use crate::dataset::source::scaled;
use crate::dataset::{HistogramSource, Labelled, Pairs, Rows, Scene};
use crate::estimation::{Estimator, Found};

use super::spread::{self, Group, Spread};

/// Errors of estimators, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Scene of each row.
    pub scenes: Vec<Scene>,
    /// Estimators and their errors.
    pub columns: Vec<EstimatorErrors>,
}

/// A row of an estimator whose true distance is known.
#[derive(Clone, Copy, Debug)]
pub struct KnownRow<'a> {
    /// Its scene.
    pub scene: &'a Scene,
    /// Estimated less true distance; none where the estimator failed [m].
    pub error_m: Option<f64>,
    /// The true distance [m].
    pub truth_m: f64,
}

/// Errors of one estimator, or of the second targets that it finds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EstimatorErrors {
    /// Name on the command line.
    pub name: &'static str,
    /// Estimated less true distance of each row; none where the estimator failed [m].
    pub errors_m: Vec<Option<f64>>,
    /// True distance of each row, where it is not the scene's; NaN of a row that does not count [m].
    pub truths_m: Vec<f64>,
    /// Estimated distance of each row, of the pixels of an array: some have no true one [m].
    pub depths_m: Vec<Option<f64>>,
}

impl EstimatorErrors {
    /// An estimator without errors yet.
    fn named(name: &'static str) -> Self {
        EstimatorErrors { name, ..EstimatorErrors::default() }
    }

    /// Adds the estimates of rows.
    fn extend<'a>(
        &mut self,
        scenes: impl Iterator<Item = &'a Scene>,
        depths_m: Vec<Option<f64>>,
        is_array: bool,
    ) {
        let pairs = depths_m.iter().zip(scenes);
        self.errors_m.extend(pairs.map(|(depth_m, scene)| Some((*depth_m)? - scene.distance_m)));
        if is_array {
            self.depths_m.extend(depths_m);
        }
    }

    /// Adds the estimates of rows with those true distances [m, m].
    fn extend_beside(&mut self, depths_m: impl Iterator<Item = Option<f64>>, truths_m: &[f64]) {
        let pairs = depths_m.zip(truths_m);
        self.errors_m.extend(pairs.map(|(depth_m, truth_m)| Some(depth_m? - truth_m)));
        self.truths_m.extend(truths_m);
    }

    /// Returns the true distance of a row [m].
    fn truth_m(&self, row: usize, scene: &Scene) -> f64 {
        self.truths_m.get(row).copied().unwrap_or(scene.distance_m)
    }
}

impl Evaluation {
    /// Draws the rows and lets every estimator see them, on all threads of the current pool; `done`
    /// hears of rows as they are done. The same for any number of threads.
    ///
    /// # Errors
    /// When an estimator needs dark histograms too and there can be none, or it is stopped.
    pub fn new(
        source: &HistogramSource,
        rows: &Rows,
        seed: u64,
        estimators: &[Box<dyn Estimator + '_>],
        stop: Option<&AtomicBool>,
        done: impl FnMut(u64),
    ) -> Result<Self> {
        let of_all = |_: &Scene| estimators;
        Evaluation::with(source, rows, seed, of_all, stop, done)
    }

    /// The same where each setting of the grid has estimators of its own, equally many with the same
    /// names.
    ///
    /// # Errors
    /// As [`Evaluation::new`].
    pub fn with<'a>(
        source: &HistogramSource,
        rows: &Rows,
        seed: u64,
        estimators: impl Fn(&Scene) -> &'a [Box<dyn Estimator + 'a>] + Sync,
        stop: Option<&AtomicBool>,
        mut done: impl FnMut(u64),
    ) -> Result<Self> {
        let first = estimators(&Scene::default());
        let mut columns: Vec<_> =
            first.iter().map(|one| EstimatorErrors::named(one.name())).collect();
        // Settings may differ in whether an estimator looks for a second target.
        let settings = if has_two(source) { rows.grid().settings() as usize } else { 0 };
        let second_of = |place: usize| {
            let of = |setting| estimators(&Scene { setting, ..Scene::default() })[place].second();
            Some(EstimatorErrors::named((0..settings).find_map(of)?.name))
        };
        let mut seconds: Vec<_> = (0..first.len()).map(second_of).collect();
        let mut scenes = Vec::with_capacity(rows.count() as usize);
        let is_array = rows.grid().array.is_some();
        let needs_dark = first.iter().any(|one| one.needs_dark());
        let pairs = needs_dark.then(|| Pairs::new(source)).transpose()?;
        for block in source.blocks(rows, seed) {
            poll_stop(stop)?;
            let drawn = pairs.map_or(Vec::new(), |pairs| pairs.draw(&block));
            for (place, column) in columns.iter_mut().enumerate() {
                let found = block.par_iter().enumerate().map(|(k, sample)| {
                    let estimator = &estimators(&sample.scene)[place];
                    let found = if estimator.needs_dark() {
                        estimator.estimate_pair(&drawn[k]).map(Found::depth)
                    } else if estimator.second().is_some() {
                        estimator.find(&sample.histogram)
                    } else {
                        estimator.estimate(&sample.histogram).map(Found::depth)
                    };
                    found.ok()
                });
                let found: Vec<_> = found.collect();
                let depths_m = found.iter().map(|found| Some(found.as_ref()?.depth_m));
                if let Some(second) = &mut seconds[place] {
                    let targets = |scene: &Scene| {
                        let second = estimators(scene)[place].second();
                        second.map_or(Targets::One, |second| second.targets)
                    };
                    let [first_m, second_m] = truths_m(source, &block, targets);
                    column.extend_beside(depths_m, &first_m);
                    let depths_m =
                        found.iter().map(|found| Some(found.as_ref()?.second.as_ref()?.depth_m));
                    second.extend_beside(depths_m, &second_m);
                } else {
                    let scenes = block.iter().map(|one| &one.scene);
                    column.extend(scenes, depths_m.collect(), is_array);
                }
            }
            scenes.extend(block.iter().map(|sample| sample.scene));
            done(block.len() as u64);
        }
        let both = columns.into_iter().zip(seconds);
        let columns = both.flat_map(|(column, second)| [Some(column), second]).flatten();
        Ok(Evaluation { scenes, columns: columns.collect() })
    }

    /// Lets every estimator see histograms whose scenes are known, on all threads of the current pool;
    /// none of them can need dark ones. Scenes have estimators as in [`Evaluation::with`].
    pub fn of_histograms<'a>(
        data: &Labelled,
        estimators: impl Fn(&Scene) -> &'a [Box<dyn Estimator + 'a>] + Sync,
    ) -> Self {
        let scenes = data.scenes.clone();
        let column = |(place, name): (usize, &'static str)| {
            let depth = |(histogram, scene): (&Histogram, &Scene)| {
                estimators(scene)[place].estimate(histogram).ok()
            };
            let depths_m = data.histograms.par_iter().zip(&scenes).map(depth).collect();
            let mut column = EstimatorErrors::named(name);
            column.extend(scenes.iter(), depths_m, data.array.is_some());
            column
        };
        let names = estimators(&Scene::default()).iter().map(|one| one.name());
        let columns = names.enumerate().map(column).collect();
        Evaluation { scenes, columns }
    }

    /// The errors of a column by what `key` is of the row's scene, in rising order of it; what is
    /// further off than `limit_m` is an outlier [m].
    pub fn by(
        &self,
        column: &EstimatorErrors,
        key: impl Fn(&Scene) -> f64,
        limit_m: f64,
    ) -> Vec<Group> {
        spread::by(self.known(column).map(|known| key(known.scene)), self.judged(column), limit_m)
    }

    /// Returns the rows of a column with a true distance.
    pub fn known(&self, column: &EstimatorErrors) -> impl Iterator<Item = KnownRow<'_>> {
        let rows = self.scenes.iter().zip(&column.errors_m).enumerate();
        let known = rows.map(|(row, (scene, &error_m))| KnownRow {
            scene,
            error_m,
            truth_m: column.truth_m(row, scene),
        });
        known.filter(|known| !known.truth_m.is_nan())
    }

    /// All errors of a column; as in [`Evaluation::by`].
    pub fn all(&self, column: &EstimatorErrors, limit_m: f64) -> Spread {
        Spread::judged(self.judged(column), limit_m)
    }

    /// Errors of a column and the true distances [m, m].
    fn judged(&self, column: &EstimatorErrors) -> impl Iterator<Item = (Option<f64>, f64)> {
        self.known(column).map(|known| (known.error_m, known.truth_m))
    }
}

/// Returns whether a scene of a source may have two targets.
fn has_two(source: &HistogramSource) -> bool {
    source.array().is_none()
        && source.scenarios().any(|scenario| scenario.target.second_share > 0.0)
}

/// Returns the true distances of the first and of the second target of the rows, as an estimator of the `targets` of
/// their scenes reports them; NaN without a second one [m].
fn truths_m(
    source: &HistogramSource,
    block: &[Sample],
    targets: impl Fn(&Scene) -> Targets,
) -> [Vec<f64>; 2] {
    let second_m: Vec<_> =
        source.scenarios().map(|scenario| scenario.target.second_distance_m).collect();
    let mut white = Last(None);
    let truths = block.iter().map(|sample| {
        let scene = &sample.scene;
        let white = white.or(scene.surfaces(), |_| source.white(scene));
        let budget = scaled(white, scene);
        let depths =
            TrueDepths::new(targets(scene), scene.distance_m, second_m[scene.setting], &budget);
        (depths.first_m, depths.second_m.unwrap_or(f64::NAN))
    });
    let (first_m, second_m) = truths.unzip();
    [first_m, second_m]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Grid, Subset};
    use crate::estimation::Failure;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    /// Finds 0.3 m wherever there are fewer hits than that.
    struct Constant(u32);

    impl Estimator for Constant {
        fn name(&self) -> &'static str {
            "constant"
        }

        fn estimate(&self, histogram: &[u32]) -> std::result::Result<f64, Failure> {
            let hits: u32 = histogram.iter().sum();
            if hits < self.0 { Ok(0.3) } else { Err(Failure::NoPeak) }
        }
    }

    fn evaluation(threads: usize) -> Evaluation {
        let few = ["firmware.shots_per_frame=300".to_owned()];
        let setup = Setup::new(scenario::load("kc705", &few).unwrap()).unwrap();
        let source = HistogramSource::new(&setup).unwrap();
        let rows = Rows::Subset(Subset::new(Grid::test(), 510, 1));
        let estimators: [Box<dyn Estimator>; 2] =
            [Box::new(Constant(u32::MAX)), Box::new(Constant(250))];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Evaluation::new(&source, &rows, 4, &estimators, None, |_| {})).unwrap()
    }

    #[test]
    fn errors_are_estimates_less_the_truth_and_failures_have_none() {
        let evaluation = evaluation(1);
        let [all, some] = &evaluation.columns[..] else { panic!("two columns") };
        for (scene, error) in evaluation.scenes.iter().zip(&all.errors_m) {
            assert_eq!(*error, Some(0.3 - scene.distance_m));
        }
        let failed = some.errors_m.iter().filter(|error| error.is_none()).count();
        assert!((100..450).contains(&failed), "{failed}");
        let by_distance = evaluation.by(some, |scene| scene.distance_m, 0.1);
        assert_eq!(by_distance.len(), 51);
        assert_eq!(
            by_distance.iter().map(|group| group.spread.failures).sum::<u64>(),
            failed as u64
        );
        assert!(by_distance.iter().all(|g| g.spread.estimates + g.spread.failures == 10));
    }

    #[test]
    fn the_number_of_threads_changes_nothing() {
        assert_eq!(evaluation(1), evaluation(3));
    }
}
