//! The rows of a dataset, drawn some at a time on all threads.

use std::ops::Range;

use rayon::prelude::*;

use tofsim::network::Histogram;

use super::grid::Scene;
use super::rows::Rows;
use super::source::HistogramSource;

/// Rows of a block: 1 MB of histograms.
pub const BLOCK: u64 = 2048;
/// Rows that a thread draws at a time.
pub(super) const RUN: u64 = 64;

/// A drawn row.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Seed of the row's random numbers.
    pub seed: u64,
    /// Row number.
    pub row: u64,
    /// Scene of the histogram.
    pub scene: Scene,
    /// Histogram, bin 0 first [hits].
    pub histogram: Histogram,
}

impl HistogramSource {
    /// Draws the rows in order, [`BLOCK`] at a time and fewer at the end, on all threads of the current
    /// pool. The same for any number of threads; memory is that of a block.
    pub fn blocks(&self, rows: &Rows, seed: u64) -> impl Iterator<Item = Vec<Sample>> + Send {
        let last = rows.count();
        (0..last)
            .step_by(BLOCK as usize)
            .map(move |begin| self.block(rows, seed, begin..last.min(begin + BLOCK)))
    }

    /// Draws neighbouring rows on all threads of the current pool, the same as in any other block.
    pub fn block(&self, rows: &Rows, seed: u64, range: Range<u64>) -> Vec<Sample> {
        let end = range.end;
        let runs: Vec<_> = range.step_by(RUN as usize).collect();
        let draw = |&from: &u64| self.run(rows, seed, from..end.min(from + RUN));
        runs.par_iter().flat_map(draw).collect()
    }

    /// The same on one thread; those of one distance or scene share what they have in common.
    fn run(&self, rows: &Rows, seed: u64, range: Range<u64>) -> Vec<Sample> {
        let mut white = Last(None);
        let mut codes = Last(None);
        let sample = |index| {
            let (row, scene) = rows.row(index);
            let white = white.or(scene.surfaces(), |_| self.white(&scene));
            let is_lit = self.is_lit_in(&scene);
            let codes = codes.or(scene.key(), |_| self.probabilities_with(white, &scene, is_lit));
            let histogram = self.draw_from(codes, &scene, seed, row);
            Sample { seed, row, scene, histogram }
        };
        range.map(sample).collect()
    }
}

/// Cache of the last key and its value.
pub(crate) struct Last<K, V>(pub(crate) Option<(K, V)>);

impl<K: PartialEq, V> Last<K, V> {
    /// Returns the value of `key`, which is computed if the last key was another.
    pub(crate) fn or(&mut self, key: K, make: impl FnOnce(&K) -> V) -> &V {
        let known = self.0.take().filter(|(last, _)| *last == key);
        let pair = known.unwrap_or_else(|| {
            let value = make(&key);
            (key, value)
        });
        &self.0.insert(pair).1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Grid, Subset};
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn source() -> HistogramSource {
        let few = ["firmware.shots_per_frame=300".to_owned()];
        HistogramSource::new(&Setup::new(scenario::load("kc705", &few).unwrap()).unwrap()).unwrap()
    }

    #[test]
    fn blocks_are_the_rows_one_by_one() {
        let source = source();
        let rows = Rows::Subset(Subset::new(Grid::test(), BLOCK + 93, 1));
        let blocks: Vec<_> = source.blocks(&rows, 3).collect();
        assert_eq!(blocks.iter().map(Vec::len).collect::<Vec<_>>(), [BLOCK as usize, 93]);
        for (index, sample) in (0..).zip(blocks.concat()) {
            let (row, scene) = rows.row(index);
            let histogram = source.draw_from(&source.probabilities(&scene), &scene, 3, row);
            assert_eq!(sample, Sample { seed: 3, row, scene, histogram });
        }
    }

    #[test]
    fn the_number_of_threads_changes_nothing() {
        let source = source();
        let rows = Rows::Subset(Subset::new(Grid::training(), 700, 1));
        let drawn = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| source.blocks(&rows, 1).flatten().collect::<Vec<_>>())
        };
        assert_eq!(drawn(1), drawn(3));
        assert_eq!(drawn(1).len(), 700);
    }
}
