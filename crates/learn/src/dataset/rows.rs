//! Rows of a dataset: all of a grid, or random scenes of it, equally many at each distance.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use tofsim::sensor::streams::{self, stream};

use super::grid::{Grid, ROWS, Scene};

/// The rows of a dataset, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Rows {
    /// All of a grid.
    All(Grid),
    /// Some of a grid's scenes, with row numbers of their own.
    Subset(Subset),
}

impl Rows {
    /// Number of rows.
    pub fn count(&self) -> u64 {
        match self {
            Rows::All(grid) => grid.rows(),
            Rows::Subset(subset) => subset.len,
        }
    }

    /// The grid that the scenes are taken from.
    pub fn grid(&self) -> &Grid {
        match self {
            Rows::All(grid) => grid,
            Rows::Subset(subset) => &subset.grid,
        }
    }

    /// The row at `index`, from 0 and below [`Rows::count`]: its number, which decides the random
    /// numbers with the seed, and the scene that its histogram is drawn for.
    pub fn row(&self, index: u64) -> (u64, Scene) {
        match self {
            Rows::All(grid) => (grid.first_row + index, grid.scene(index)),
            Rows::Subset(subset) => (subset.first_row() + index, subset.scene(index)),
        }
    }
}

/// So many rows of a grid, in order of distance.
///
/// The numbers of rows at any two distances differ by 1 at most. At a distance, lights are drawn
/// without putting back, and anew when all have been drawn; of more than [`MOST_LEFT`] lights, with
/// putting back. Row numbers are none of the grid's, so that draws are fresh even with the grid's seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Subset {
    /// Grid of the scenes.
    pub grid: Grid,
    /// Number of rows.
    pub len: u64,
    /// Seed of the choice.
    pub seed: u64,
}

impl Subset {
    /// `len` rows of a grid, chosen by `seed`.
    pub fn new(grid: Grid, len: u64, seed: u64) -> Self {
        Subset { grid, len, seed }
    }

    /// Row number of index 0.
    pub fn first_row(&self) -> u64 {
        self.grid.first_row + ROWS
    }

    /// Scene of a row; `index` counts from 0 and is below `len`.
    pub fn scene(&self, index: u64) -> Scene {
        let (distances, lights) = (self.grid.distances_m.count(), self.grid.lights());
        // Exact for any number of rows.
        let (index, len) = (u128::from(index), u128::from(self.len.max(1)));
        let distance = index * u128::from(distances) / len;
        let first = (distance * len).div_ceil(u128::from(distances));
        let (distance, place) = (distance as u64, (index - first) as u64);
        if lights > MOST_LEFT {
            let mut random =
                stream(self.seed, streams::Source::Scene, self.first_row() + index as u64);
            return self.grid.scene_at(distance, random.random_range(0..lights));
        }
        let round = place / lights;
        let numbers = self.first_row() + (round * distances + distance);
        let mut random = stream(self.seed, streams::Source::Scene, numbers);
        self.grid.scene_at(distance, drawn(lights, place % lights, &mut random))
    }
}

/// Lights that are drawn without putting back: each draw looks at all of them.
const MOST_LEFT: u64 = 4096;

/// Returns the draw after `before` others from `0..count`, without replacement.
fn drawn(count: u64, before: u64, random: &mut ChaCha8Rng) -> u64 {
    let mut left: Vec<u64> = (0..count).collect();
    for _ in 0..before {
        let place = random.random_range(0..left.len());
        left.swap_remove(place);
    }
    left[random.random_range(0..left.len())]
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Counts how often each scene is chosen, by distance, reflectance and irradiance.
    fn chosen(subset: &Subset) -> BTreeMap<[u64; 3], usize> {
        let mut counts = BTreeMap::new();
        for index in 0..subset.len {
            let scene = subset.scene(index);
            let key = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
            *counts.entry(key.map(f64::to_bits)).or_default() += 1;
        }
        counts
    }

    #[test]
    fn distances_have_equal_numbers_of_rows_in_order() {
        for len in [1, 200, 201, 8_000] {
            let subset = Subset::new(Grid::training(), len, 1);
            let distances: Vec<_> = (0..len).map(|index| subset.scene(index).distance_m).collect();
            assert!(distances.is_sorted());
            let rows = distances.chunk_by(|a, b| a == b).map(<[_]>::len);
            let (least, most) = (rows.clone().min().unwrap(), rows.clone().max().unwrap());
            assert!(most - least <= 1, "{len}: {least} to {most}");
            assert_eq!(rows.count() as u64, len.min(201));
        }
    }

    #[test]
    fn no_scene_comes_again_before_all_have_come() {
        let grid = Grid::test();
        let once = chosen(&Subset::new(grid.clone(), 51 * 100, 1));
        assert!(once.values().all(|&count| count == 1));
        let often = chosen(&Subset::new(grid.clone(), 51 * 500, 1));
        assert_eq!(often.len() as u64, 51 * grid.lights());
        assert!(often.values().all(|count| (1..=2).contains(count)));
    }

    #[test]
    fn the_choice_is_the_seed_s() {
        let scenes = |seed| {
            let subset = Subset::new(Grid::training(), 400, seed);
            (0..400).map(|index| subset.scene(index)).collect::<Vec<_>>()
        };
        assert_eq!(scenes(1), scenes(1));
        let same = scenes(1).iter().zip(scenes(2)).filter(|(a, b)| **a == *b).count();
        assert!(same < 10, "{same} of 400");
    }

    #[test]
    fn all_lights_are_chosen_equally_often() {
        let grid = Grid::training();
        let len = 201 * 50;
        let mut counts = [[0.0; 53]; 9];
        let subset = Subset::new(grid.clone(), len, 3);
        for scene in (0..len).map(|index| subset.scene(index)) {
            let of = |axis: &crate::dataset::Axis, value| {
                axis.values.iter().position(|known| *known == value).unwrap()
            };
            let irradiance = of(&grid.irradiances_w_m2_nm, scene.irradiance_w_m2_nm);
            counts[irradiance][of(&grid.reflectances, scene.reflectance)] += 1.0;
        }
        let mean = len as f64 / 477.0;
        let chi2: f64 = counts.iter().flatten().map(|n| (n - mean) * (n - mean) / mean).sum();
        // Without putting back the counts vary less than by chance: chi2 is 477 (1 - 50/477).
        assert!((300.0..560.0).contains(&chi2), "{chi2}");
    }

    #[test]
    fn of_very_many_lights_each_is_drawn_at_once() {
        let axis = |option| crate::dataset::Axis::parse("--grid", option).unwrap();
        let axes = [axis("target.distance_m=0.1,0.2"), axis("target.reflectance=0.1..0.9:0.00001")];
        let purpose = crate::dataset::GridPurpose::Training;
        let grid = Grid::own(&axes, &Default::default(), purpose).unwrap();
        let subset = Subset::new(grid, 20_000, 1);
        let mean = (0..20_000).map(|index| subset.scene(index).reflectance).sum::<f64>() / 2e4;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert_eq!([0, 19_999].map(|index| subset.scene(index).distance_m), [0.1, 0.2]);
    }

    #[test]
    fn no_two_sets_share_a_row_number() {
        let (train, test) = (Grid::training(), Grid::test());
        let subset = |grid: &Grid| Rows::Subset(Subset::new(grid.clone(), 1_000_000, 1));
        let (few, some) = (subset(&train), subset(&test));
        let numbers = [Rows::All(train), few, Rows::All(test), some]
            .map(|rows| (rows.row(0).0, rows.row(rows.count() - 1).0));
        assert!(numbers.windows(2).all(|pair| pair[0].1 < pair[1].0), "{numbers:?}");
        assert!(numbers[3].1 < 1 << 56, "beyond what a stream can hold");
    }
}
