//! A dark and a lit histogram for each row, of half the shots each, beside the row's own.

use rayon::prelude::*;

use tofsim::error::Input;
use tofsim::optics::BinProbabilities;
use tofsim::sensor::streams::{self, stream};

use crate::estimation::HistogramPair;
use crate::estimation::subtraction::half;

use super::blocks::{Last, RUN, Sample};
use super::source::HistogramSource;

/// Draws pairs of any scene, all else being as a source has it.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a> {
    source: &'a HistogramSource,
}

impl<'a> Pairs<'a> {
    /// With half of the source's shots for each histogram.
    ///
    /// # Errors
    /// When they have no half, or the laser never fires.
    pub fn new(source: &'a HistogramSource) -> Result<Self, Input> {
        for scenario in source.scenarios() {
            half(scenario.firmware.shots_per_frame)?;
        }
        if source.scenarios().any(|scenario| !scenario.firmware.laser_en) {
            let expected = "expected true: a lit histogram needs the laser";
            let fault = Input::new("subtraction", expected).field("firmware.laser_en");
            return Err(fault.value(false));
        }
        Ok(Pairs { source })
    }

    /// Pairs for the rows of `samples`, on all threads of the current pool. Each row's comes from a
    /// stream of its own.
    pub fn draw(&self, samples: &[Sample]) -> Vec<HistogramPair> {
        samples.par_chunks(RUN as usize).flat_map_iter(|samples| self.run(samples)).collect()
    }

    /// Neighbouring rows share what they have in common.
    fn run(&self, samples: &[Sample]) -> Vec<HistogramPair> {
        let (mut white, mut codes) = (Last(None), Last(None));
        let pair = |sample: &Sample| {
            let scene = sample.scene;
            let white = white.or(scene.surfaces(), |_| self.source.white(&scene));
            let of = |lit| self.source.probabilities_with(white, &scene, lit);
            let codes: &[BinProbabilities; 2] = codes.or(scene.key(), |_| [false, true].map(of));
            let mut random = stream(sample.seed, streams::Source::DatasetPair, sample.row);
            let [dark, lit] = [0, 1].map(|kind| {
                let shots = u64::from(self.source.shots_of(&scene)) / 2;
                let counts = codes[kind].draw(shots, &mut random);
                counts.into_iter().map(|count| count as u32).collect()
            });
            HistogramPair { dark, lit }
        };
        samples.iter().map(pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Grid, Rows, Scene, Subset};
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn source(keys: &[&str]) -> HistogramSource {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        HistogramSource::new(&Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap()).unwrap()
    }

    #[test]
    fn the_number_of_threads_and_the_rows_beside_change_nothing() {
        let source = source(&["firmware.shots_per_frame=600"]);
        let pairs = Pairs::new(&source).unwrap();
        let rows = Rows::Subset(Subset::new(Grid::test(), 204, 1));
        let samples: Vec<_> = source.blocks(&rows, 1).flatten().collect();
        let drawn = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| pairs.draw(&samples))
        };
        assert_eq!(drawn(1), drawn(3));
        assert_eq!(drawn(1)[77], pairs.draw(&samples[77..78])[0]);
    }

    #[test]
    fn dark_and_lit_have_the_means_of_their_probabilities() {
        let source = source(&[]);
        let pairs = Pairs::new(&source).unwrap();
        let scene = Scene {
            distance_m: 0.5,
            reflectance: 0.34,
            irradiance_w_m2_nm: 0.2,
            ..Scene::default()
        };
        let rows = 400;
        let sample = |row| Sample { seed: 1, row, scene, histogram: vec![0; 256] };
        let drawn = pairs.draw(&(0..rows).map(sample).collect::<Vec<_>>());
        let white = source.white(&scene);
        for lit in [false, true] {
            let codes = source.probabilities_with(&white, &scene, lit);
            let of =
                |pair: &HistogramPair, bin: usize| if lit { pair.lit[bin] } else { pair.dark[bin] };
            let (mut chi2, mut cells) = (0.0, 0.0);
            for (bin, p) in codes.of_code().iter().enumerate() {
                let found: f64 = drawn.iter().map(|pair| f64::from(of(pair, bin))).sum();
                let expected = 15_000.0 * rows as f64 * p;
                if expected > 25.0 {
                    (chi2, cells) = (chi2 + (found - expected).powi(2) / expected, cells + 1.0);
                }
            }
            let off = (chi2 - cells) / f64::sqrt(2.0 * cells);
            assert!(off.abs() < 4.5, "{lit}: {chi2} of {cells}");
        }
    }

    #[test]
    fn what_makes_no_pair_is_refused() {
        let refused = |key: &str| Pairs::new(&source(&[key])).unwrap_err().to_string();
        assert!(refused("firmware.shots_per_frame=301").contains("shots = 301: expected an even"));
        assert!(refused("firmware.laser_en=false").contains("firmware.laser_en = false"));
    }
}
