//! Grids of scenes: every distance with every irradiance and reflectance, and with every value of any
//! other key. The thesis's (section 5.4) are two of them.

use tofsim::error::{Input, Result};
use tofsim::scenario::Scenario;

use super::axis::Axis;
use super::grid_array::GridArray;

/// Key of the distance, what an estimator is to find [m].
pub const DISTANCE: &str = "target.distance_m";
/// Key of the reflectance [1].
pub const REFLECTANCE: &str = "target.reflectance";
/// Key of the ambient light [W/m^2/nm].
pub const IRRADIANCE: &str = "ambient.irradiance_w_m2_nm";

/// Keys of the size of an array.
const SIZES: [&str; 2] = ["array.rows", "array.columns"];

/// Variable part of the scene; everything else is the scenario's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scene {
    /// Distance of the target, what an estimator is to find (`target.distance_m`). That of a pixel of an array is its
    /// true radial depth, and NaN where no light returns [m].
    pub distance_m: f64,
    /// Reflectance of the target (`target.reflectance`) [1].
    pub reflectance: f64,
    /// Spectral irradiance of the target (`ambient.irradiance_w_m2_nm`) [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
    /// Index of the values of the grid's other keys, from 0 ([`Grid::setting`]).
    pub setting: usize,
    /// Index of the pixel by row, then column ([`GridArray::place`]); 0 of a single one.
    pub pixel: usize,
}

impl Scene {
    /// Returns a key that two scenes share if light comes to them from the same surfaces.
    pub(crate) fn surfaces(&self) -> (u64, usize, usize) {
        (self.distance_m.to_bits(), self.setting, self.pixel)
    }

    /// Returns a key that is each scene's own, also without a distance.
    pub(crate) fn key(&self) -> (usize, usize, [u64; 3]) {
        // The bits of numbers from 0 on are in the order of the numbers.
        let numbers = [self.distance_m, self.reflectance, self.irradiance_w_m2_nm];
        (self.setting, self.pixel, numbers.map(f64::to_bits))
    }
}

/// Purpose of a custom grid; different purposes have independent random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridPurpose {
    /// Training, and datasets.
    Training,
    /// Tests.
    Test,
}

/// A grid of scenes, each repeated.
///
/// The index counts repeats first, then pixels, reflectances, irradiances, the other keys and distances: rows
/// of one scene are neighbours, and those of one distance are together.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The thesis's `train` or `test`, or `own`.
    pub name: &'static str,
    /// Distances of the target [m]. The pixels of an array have distances of their own: several of the target are among
    /// the other keys, and this one stands for nothing.
    pub distances_m: Axis,
    /// Spectral irradiances of the target [W/m^2/nm].
    pub irradiances_w_m2_nm: Axis,
    /// Reflectances of the target [1].
    pub reflectances: Axis,
    /// Other keys of the scenario, the last one changing fastest.
    pub others: Vec<Axis>,
    /// Pixels of each scene, if there are several.
    pub array: Option<GridArray>,
    /// Histograms of each scene [1].
    pub repeats: u64,
    /// Row number of index 0; no two grids share row numbers.
    pub first_row: u64,
}

/// Row numbers that a grid or a subset has for itself.
pub(super) const ROWS: u64 = 1 << 40;
/// Most rows of a grid, 51 GB of histograms.
pub const MOST_ROWS: u64 = 100_000_000;
/// Most combinations of values that the other keys have.
const MOST_SETTINGS: u64 = 4096;
/// Name of a grid that is not the thesis's.
const OWN: &str = "own";

impl Grid {
    /// The thesis's for training: 201 distances, 479,385 rows.
    pub fn training() -> Self {
        Grid {
            name: "train",
            distances_m: Axis::steps(DISTANCE, 1000, 25, 201, 10_000),
            irradiances_w_m2_nm: Axis::steps(IRRADIANCE, 0, 5, 9, 100),
            reflectances: Axis::steps(REFLECTANCE, 8, 1, 53, 100),
            others: Vec::new(),
            array: None,
            repeats: 5,
            first_row: 0,
        }
    }

    /// The thesis's for tests: 51 distances, 121,635 rows. Its scenes are among those of training, its
    /// draws are not.
    pub fn test() -> Self {
        let distances_m = Axis::steps(DISTANCE, 10, 1, 51, 100);
        Grid { name: "test", distances_m, first_row: 2 * ROWS, ..Grid::training() }
    }

    /// Of axes of one's own; distance, reflectance and irradiance are the scenario's where no axis has
    /// them. Of an array, every scene has all pixels, whose distances are still to come
    /// ([`GridArray::with_depths`]).
    ///
    /// # Errors
    /// When two axes have the same key, one has the size of the array, or there are too many rows.
    pub fn own(axes: &[Axis], scenario: &Scenario, purpose: GridPurpose) -> Result<Self> {
        let same = |(k, axis): (usize, &Axis)| axes[..k].iter().any(|one| one.key == axis.key);
        if let Some(k) = axes.iter().enumerate().position(same) {
            return Err(Input::new("--grid", "expected each key once").field(&axes[k].key).into());
        }
        if let Some(axis) = axes.iter().find(|axis| SIZES.contains(&&*axis.key)) {
            let expected = "expected no axis: the rows of a grid are the pixels of one array, whose size -s sets";
            return Err(Input::new("--grid", expected).field(&axis.key).value(&axis.text).into());
        }
        let axis = |key, value| {
            let own = axes.iter().find(|axis| axis.key == key);
            own.cloned().unwrap_or_else(|| Axis::single(key, value))
        };
        let Scenario { target, ambient, .. } = scenario;
        let array = GridArray::of(scenario);
        let is_other = |axis: &&Axis| match &*axis.key {
            DISTANCE => array.is_some(),
            key => ![REFLECTANCE, IRRADIANCE].contains(&key),
        };
        let others = axes.iter().filter(is_other).cloned().collect();
        let grid = Grid {
            name: OWN,
            distances_m: match array {
                Some(_) => Axis::single(DISTANCE, target.distance_m),
                None => axis(DISTANCE, target.distance_m),
            },
            irradiances_w_m2_nm: axis(IRRADIANCE, ambient.irradiance_w_m2_nm),
            reflectances: axis(REFLECTANCE, target.reflectance),
            others,
            array,
            repeats: 5,
            first_row: match purpose {
                GridPurpose::Training => 4 * ROWS,
                GridPurpose::Test => 6 * ROWS,
            },
        };
        let most = [("settings of other keys", grid.settings(), MOST_SETTINGS)];
        let all = [("scenes", grid.scenes(), MOST_ROWS)];
        for (what, count, most) in most.into_iter().chain(all) {
            if count > most {
                let expected = format!("{count} {what}, expected {most} at most");
                return Err(Input::new("--grid", expected).into());
            }
        }
        Ok(grid)
    }

    /// With so many histograms of each scene.
    ///
    /// # Errors
    /// When there are too many rows.
    pub fn repeated(self, repeats: u64) -> Result<Self> {
        let grid = Grid { repeats, ..self };
        let rows = grid.rows();
        if rows > MOST_ROWS {
            let expected = format!("{rows} histograms, expected {MOST_ROWS} at most; see --rows");
            return Err(Input::new("--grid", expected).into());
        }
        Ok(grid)
    }

    /// The same with `most` distances at most.
    pub fn with_distances(&self, most: usize) -> Self {
        Grid { distances_m: self.distances_m.thinned(most), ..self.clone() }
    }

    /// Returns whether this is one of the thesis's grids.
    pub fn is_thesis(&self) -> bool {
        self.name != OWN
    }

    /// All axes, those of a scene first.
    pub fn axes(&self) -> impl Iterator<Item = &Axis> {
        let scene = [&self.distances_m, &self.irradiances_w_m2_nm, &self.reflectances];
        let first = usize::from(self.array.is_some());
        scene.into_iter().skip(first).chain(&self.others)
    }

    /// The least and the largest value of each key of the scenario. The distances of an array are those of its pixels.
    pub fn ranges(&self) -> Vec<(&str, [f64; 2])> {
        let ranges = self.axes().map(|axis| (&*axis.key, axis.range()));
        let Some(array) = &self.array else { return ranges.collect() };
        let others = ranges.filter(|(key, _)| *key != DISTANCE);
        [(DISTANCE, array.range_m())].into_iter().chain(others).collect()
    }

    /// Number of rows.
    pub fn rows(&self) -> u64 {
        self.scenes().saturating_mul(self.repeats)
    }

    /// Number of scenes, each pixel's being one of them.
    pub fn scenes(&self) -> u64 {
        self.distances_m.count().saturating_mul(self.lights())
    }

    /// Number of scenes at a distance.
    pub fn lights(&self) -> u64 {
        self.settings().saturating_mul(self.lights_of_a_setting()).saturating_mul(self.pixels())
    }

    /// Number of pixels.
    fn pixels(&self) -> u64 {
        self.array.as_ref().map_or(1, |array| array.count() as u64)
    }

    fn lights_of_a_setting(&self) -> u64 {
        self.irradiances_w_m2_nm.count().saturating_mul(self.reflectances.count())
    }

    /// Number of settings: combinations of the other keys' values.
    pub fn settings(&self) -> u64 {
        self.others.iter().map(Axis::count).fold(1, u64::saturating_mul)
    }

    /// Keys and values of a setting; `setting` counts from 0.
    pub fn setting(&self, setting: usize) -> Vec<(&str, f64)> {
        let mut left = setting as u64;
        let value = |axis: &Axis, left: &mut u64| {
            let place = *left % axis.count();
            *left /= axis.count();
            axis.values[place as usize]
        };
        let backwards = self.others.iter().rev().map(|axis| (&*axis.key, value(axis, &mut left)));
        let mut values: Vec<_> = backwards.collect();
        values.reverse();
        values
    }

    /// Scene of a row; `index` counts from 0 and is below [`Grid::rows`].
    pub fn scene(&self, index: u64) -> Scene {
        let scene = index / self.repeats;
        self.scene_at(scene / self.lights(), scene % self.lights())
    }

    /// A scene by the place of its distance and of its light, setting, irradiance, reflectance and pixel,
    /// both from 0.
    pub fn scene_at(&self, distance: u64, light: u64) -> Scene {
        let (light, pixel) = (light / self.pixels(), (light % self.pixels()) as usize);
        let (setting, light) =
            (light / self.lights_of_a_setting(), light % self.lights_of_a_setting());
        let (setting, reflectances) = (setting as usize, self.reflectances.count());
        let reflectance = self.reflectances.values[(light % reflectances) as usize];
        Scene {
            distance_m: match &self.array {
                Some(array) => array.depth_m(setting, pixel, reflectance),
                None => self.distances_m.values[distance as usize],
            },
            reflectance,
            irradiance_w_m2_nm: self.irradiances_w_m2_nm.values[(light / reflectances) as usize],
            setting,
            pixel,
        }
    }
}

#[cfg(test)]
mod tests;
