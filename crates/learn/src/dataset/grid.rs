//! The thesis's grids of scenes (section 5.4): every distance with every irradiance and reflectance.

/// What the sensor looks at; all else is the scenario's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Distance of the target, what an estimator is to find (`target.distance_m`) [m].
    pub distance_m: f64,
    /// Reflectance of the target (`target.reflectance`) [1].
    pub reflectance: f64,
    /// Spectral irradiance of the target (`ambient.irradiance_w_m2_nm`) [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
}

/// Equally spaced decimals: `(first + k step) / per_unit` for `k` below `count`, each the `f64`
/// nearest to the decimal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// First value, in parts of a unit.
    pub first: u32,
    /// From one value to the next, in parts of a unit.
    pub step: u32,
    /// Number of values [1].
    pub count: u64,
    /// Parts of a unit [1].
    pub per_unit: u32,
}

impl Steps {
    /// Value `k`, from 0, in the unit.
    pub fn value(&self, k: u64) -> f64 {
        (u64::from(self.first) + k * u64::from(self.step)) as f64 / f64::from(self.per_unit)
    }
}

/// A grid of scenes, each repeated.
///
/// The index counts repeats first, then reflectances, irradiances and distances: rows of one scene
/// are neighbours, and those of one distance are together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// What the grid is for: `train` or `test`.
    pub name: &'static str,
    /// Distances of the target [m].
    pub distances_m: Steps,
    /// Spectral irradiances of the target [W/m^2/nm].
    pub irradiances_w_m2_nm: Steps,
    /// Reflectances of the target [1].
    pub reflectances: Steps,
    /// Histograms of each scene [1].
    pub repeats: u64,
    /// Row number of index 0; no two grids share row numbers.
    pub first_row: u64,
}

/// Row numbers that a grid or a subset has for itself.
pub(super) const ROWS: u64 = 1 << 40;

impl Grid {
    /// For training: 201 distances, 479,385 rows.
    pub const fn training() -> Self {
        Grid {
            name: "train",
            distances_m: Steps { first: 1000, step: 25, count: 201, per_unit: 10_000 },
            irradiances_w_m2_nm: Steps { first: 0, step: 5, count: 9, per_unit: 100 },
            reflectances: Steps { first: 8, step: 1, count: 53, per_unit: 100 },
            repeats: 5,
            first_row: 0,
        }
    }

    /// For tests: 51 distances, 121,635 rows. Its scenes are among those of training, its draws are
    /// not.
    pub const fn test() -> Self {
        let distances_m = Steps { first: 10, step: 1, count: 51, per_unit: 100 };
        Grid { name: "test", distances_m, first_row: 2 * ROWS, ..Grid::training() }
    }

    /// The least and the largest value of each key of the scenario.
    pub fn ranges(&self) -> [(&'static str, [f64; 2]); 3] {
        let range = |steps: &Steps| [0, steps.count - 1].map(|k| steps.value(k));
        [
            ("target.distance_m", range(&self.distances_m)),
            ("target.reflectance", range(&self.reflectances)),
            ("ambient.irradiance_w_m2_nm", range(&self.irradiances_w_m2_nm)),
        ]
    }

    /// Number of rows.
    pub fn rows(&self) -> u64 {
        self.distances_m.count * self.lights() * self.repeats
    }

    /// Number of scenes at a distance.
    pub fn lights(&self) -> u64 {
        self.irradiances_w_m2_nm.count * self.reflectances.count
    }

    /// Scene of a row; `index` counts from 0 and is below [`Grid::rows`].
    pub fn scene(&self, index: u64) -> Scene {
        let scene = index / self.repeats;
        self.scene_at(scene / self.lights(), scene % self.lights())
    }

    /// A scene by the place of its distance and of its light, irradiance and reflectance, both from
    /// 0.
    pub fn scene_at(&self, distance: u64, light: u64) -> Scene {
        let reflectances = &self.reflectances;
        Scene {
            distance_m: self.distances_m.value(distance),
            reflectance: reflectances.value(light % reflectances.count),
            irradiance_w_m2_nm: self.irradiances_w_m2_nm.value(light / reflectances.count),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grids_are_those_of_the_thesis() {
        assert_eq!(Grid::training().rows(), 479_385);
        assert_eq!(Grid::test().rows(), 121_635);
        for grid in [Grid::training(), Grid::test()] {
            let scene = |d, r, e| Scene { distance_m: d, reflectance: r, irradiance_w_m2_nm: e };
            assert_eq!(grid.scene(0), scene(0.1, 0.08, 0.0));
            assert_eq!(grid.scene(4), grid.scene(0));
            assert_eq!(grid.scene(5), scene(0.1, 0.09, 0.0));
            assert_eq!(grid.scene(53 * 5), scene(0.1, 0.08, 0.05));
            assert_eq!(grid.scene(grid.rows() - 1), scene(0.6, 0.6, 0.4));
        }
        assert_eq!(Grid::training().scene(53 * 9 * 5).distance_m, 0.1025);
        assert_eq!(Grid::test().scene(53 * 9 * 5).distance_m, 0.11);
    }

    #[test]
    fn every_value_is_the_decimal_that_a_user_would_type() {
        let check = |steps: Steps, decimals: usize| {
            for value in (0..steps.count).map(|k| steps.value(k)) {
                let typed: f64 = format!("{value:.decimals$}").parse().unwrap();
                assert_eq!(value, typed);
            }
        };
        check(Grid::training().distances_m, 4);
        check(Grid::test().distances_m, 2);
        check(Grid::test().irradiances_w_m2_nm, 2);
        check(Grid::test().reflectances, 2);
    }
}
