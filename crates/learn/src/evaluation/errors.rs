//! The errors of estimators, histogram by histogram.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use tofsim::error::{Result, poll_stop};
use tofsim::network::Histogram;

use crate::dataset::{HistogramSource, Labelled, Pairs, Rows, Scene};
use crate::estimation::Estimator;

use super::spread::{self, Group, Spread};

/// Errors of estimators, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Scene of each row.
    pub scenes: Vec<Scene>,
    /// Estimators and their errors.
    pub columns: Vec<EstimatorErrors>,
}

/// Errors of one estimator.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EstimatorErrors {
    /// Name on the command line.
    pub name: &'static str,
    /// Estimated less true distance of each row; none where the estimator failed [m].
    pub errors_m: Vec<Option<f64>>,
    /// Estimated distance of each row, of the pixels of an array: some have no true one [m].
    pub depths_m: Vec<Option<f64>>,
}

impl EstimatorErrors {
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
        let empty = || Vec::with_capacity(rows.count() as usize);
        let columns = first.iter();
        let columns = columns.map(|one| EstimatorErrors {
            name: one.name(),
            errors_m: empty(),
            depths_m: Vec::new(),
        });
        let mut columns: Vec<EstimatorErrors> = columns.collect();
        let mut scenes = Vec::with_capacity(rows.count() as usize);
        let is_array = rows.grid().array.is_some();
        let needs_dark = first.iter().any(|one| one.needs_dark());
        let pairs = needs_dark.then(|| Pairs::new(source)).transpose()?;
        for block in source.blocks(rows, seed) {
            poll_stop(stop)?;
            let drawn = pairs.map_or(Vec::new(), |pairs| pairs.draw(&block));
            for (place, column) in columns.iter_mut().enumerate() {
                let depths_m = block.par_iter().enumerate().map(|(k, sample)| {
                    let estimator = &estimators(&sample.scene)[place];
                    let found = if estimator.needs_dark() {
                        estimator.estimate_pair(&drawn[k])
                    } else {
                        estimator.estimate(&sample.histogram)
                    };
                    found.ok()
                });
                let (depths_m, scenes) = (depths_m.collect(), block.iter().map(|one| &one.scene));
                column.extend(scenes, depths_m, is_array);
            }
            scenes.extend(block.iter().map(|sample| sample.scene));
            done(block.len() as u64);
        }
        Ok(Evaluation { scenes, columns })
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
            let mut column = EstimatorErrors { name, ..EstimatorErrors::default() };
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
        spread::by(self.known(column).map(|(scene, _)| key(scene)), self.judged(column), limit_m)
    }

    /// Returns the scenes with a true distance, and the errors of a column in them [m].
    pub fn known(&self, column: &EstimatorErrors) -> impl Iterator<Item = (&Scene, Option<f64>)> {
        let rows = self.scenes.iter().zip(column.errors_m.iter().copied());
        rows.filter(|(scene, _)| !scene.distance_m.is_nan())
    }

    /// All errors of a column; as in [`Evaluation::by`].
    pub fn all(&self, column: &EstimatorErrors, limit_m: f64) -> Spread {
        Spread::judged(self.judged(column), limit_m)
    }

    /// Errors of a column and the true distances [m, m].
    fn judged(&self, column: &EstimatorErrors) -> impl Iterator<Item = (Option<f64>, f64)> {
        self.known(column).map(|(scene, error_m)| (error_m, scene.distance_m))
    }
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
