//! Histograms of one's own as what a network is trained, chosen and tested on: those of each distance are
//! dealt out once, so that no test sees what a training has seen.

use rand::RngExt;

use tofsim::error::Input;
use tofsim::optics::Bins;
use tofsim::sensor::streams::{self, stream};

use crate::dataset::Labelled;

use super::data::{PulseTimes, Purpose, Samples, TrainingMaterial};
use super::recipe::Recipe;
use super::start::derived;

/// Histograms of a distance, so that each part has some.
const LEAST: usize = 10;
/// Histograms in a hundred for the choice, and as many for the test; the rest is for training, as MATLAB's
/// `dividerand` has it.
const PERCENT: usize = 15;
/// Place of the dealing among the seeds that a training derives.
const DEALING: u64 = 5;

/// The three parts.
#[derive(Clone, Debug)]
pub struct MeasuredParts {
    training: Samples,
    choice: Samples,
    test: Samples,
    distances_m: Vec<f64>,
    bins: Bins,
    pulse: PulseTimes,
}

impl MeasuredParts {
    /// Deals out histograms of those bins, of a pulse with that delay and width, by a seed.
    ///
    /// # Errors
    /// When there are fewer than ten histograms at a distance.
    pub fn new(
        labelled: &Labelled,
        bins: Bins,
        pulse: PulseTimes,
        seed: u64,
    ) -> Result<Self, Input> {
        let seed = derived(seed, DEALING);
        let place = |row: usize| -> (f64, u64) {
            let mut random = stream(seed, streams::Source::Scene, row as u64);
            (labelled.scenes[row].distance_m, random.random())
        };
        // A pixel of an array may have no distance.
        let is_known = |row: &usize| !labelled.scenes[*row].distance_m.is_nan();
        let known = (0..labelled.scenes.len()).filter(is_known);
        let mut rows: Vec<_> = known.map(|row| (place(row), row)).collect();
        rows.sort_by(|(a, _), (b, _)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut parts = MeasuredParts {
            training: Samples::default(),
            choice: Samples::default(),
            test: Samples::default(),
            distances_m: Vec::new(),
            bins,
            pulse,
        };
        for same in rows.chunk_by(|((a, _), _), ((b, _), _)| a == b) {
            let ((distance_m, _), _) = same[0];
            if same.len() < LEAST {
                let expected =
                    format!("histograms at {distance_m} m, expected {LEAST} or more to train on");
                return Err(Input::new("--data", expected).value(same.len()));
            }
            let part = same.len() * PERCENT / 100;
            for (k, &(_, row)) in same.iter().enumerate() {
                let samples = match k {
                    _ if k < part => &mut parts.choice,
                    _ if k < 2 * part => &mut parts.test,
                    _ => &mut parts.training,
                };
                samples.counts.push(labelled.histograms[row].clone());
                samples.distances_m.push(distance_m);
            }
            parts.distances_m.push(distance_m);
        }
        Ok(parts)
    }

    /// A number that changes with any of them.
    pub fn digest(&self) -> u64 {
        let parts = [&self.training, &self.choice, &self.test];
        parts.iter().fold(0, |digest, part| digest.rotate_left(1) ^ part.digest())
    }
}

impl TrainingMaterial for MeasuredParts {
    fn distances_m(&self) -> &[f64] {
        &self.distances_m
    }

    fn bins(&self) -> &Bins {
        &self.bins
    }

    fn pulse_times(&self) -> PulseTimes {
        self.pulse
    }

    /// A stage has the training's histograms, or every so many one of them if it wants fewer.
    fn draw(&self, recipe: &Recipe, _: u64, purpose: Purpose) -> Samples {
        let stage = match purpose {
            Purpose::Choice | Purpose::Validation => return self.choice.clone(),
            Purpose::Test => return self.test.clone(),
            Purpose::Stage(stage) => stage,
        };
        let all = self.training.counts.len();
        let wanted = usize::try_from(recipe.stage(stage).samples).unwrap_or(all).clamp(1, all);
        // Every stage begins at another one.
        let first = (stage * 7919) % all;
        let place = |k| ((k as u128 * all as u128 + first as u128) / wanted as u128) as usize;
        let Samples { counts, distances_m } = &self.training;
        let sample = |place: usize| (counts[place].clone(), distances_m[place]);
        let (counts, distances_m) = (0..wanted).map(place).map(sample).unzip();
        Samples { counts, distances_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::Scene;
    use tofsim::sim::setup::Setup;

    /// So many histograms at 0.3 and 0.2 m in turn, each unlike the others.
    fn labelled(count: u32) -> Labelled {
        let scene = |k: u32| Scene { distance_m: [0.3, 0.2][(k % 2) as usize], ..Scene::default() };
        let scenes = (0..count).map(scene).collect();
        Labelled {
            histograms: (0..count).map(|k| vec![k; 256]).collect(),
            scenes,
            ..Labelled::default()
        }
    }

    const PULSE: PulseTimes = PulseTimes { delay_ps: 0.0, sigma_ps: 137.0 };

    fn bins() -> Bins {
        Setup::load("kc705", &[]).unwrap().bins()
    }

    #[test]
    fn every_histogram_is_in_one_part_with_its_distance() {
        let parts = MeasuredParts::new(&labelled(400), bins(), PULSE, 1).unwrap();
        let recipe = Recipe::quick();
        let of = |purpose| parts.draw(&recipe, 1, purpose);
        let [stage, choice, test] = [Purpose::Stage(0), Purpose::Choice, Purpose::Test].map(of);
        assert_eq!((stage.counts.len(), choice.counts.len(), test.counts.len()), (280, 60, 60));
        let mut seen: Vec<_> =
            [&stage, &choice, &test].iter().flat_map(|part| &part.counts).collect();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 400);
        for part in [&stage, &choice, &test] {
            assert!(part.distances_m.is_sorted());
            let fits = |(counts, m): (&Vec<u32>, &f64)| *m == [0.3, 0.2][counts[0] as usize % 2];
            assert!(part.counts.iter().zip(&part.distances_m).all(fits));
        }
        let other = MeasuredParts::new(&labelled(400), bins(), PULSE, 2).unwrap();
        assert_ne!(other.draw(&recipe, 2, Purpose::Test), test);
        assert_ne!(other.digest(), parts.digest());
    }

    #[test]
    fn a_stage_that_wants_fewer_has_some_of_every_distance() {
        let parts = MeasuredParts::new(&labelled(2000), bins(), PULSE, 1).unwrap();
        let recipe = Recipe::quick();
        let [a, b] = [0, 1].map(|stage| parts.draw(&recipe, 1, Purpose::Stage(stage)));
        assert_eq!((a.counts.len(), b.counts.len()), (603, 1005));
        let near = a.distances_m.iter().filter(|m| **m == 0.2).count();
        assert!((300..=303).contains(&near), "{near}");
    }

    #[test]
    fn few_histograms_of_a_distance_are_refused() {
        let error = MeasuredParts::new(&labelled(19), bins(), PULSE, 1).unwrap_err().to_string();
        assert!(error.contains("9: histograms at 0.2 m, expected 10 or more"), "{error}");
    }
}
