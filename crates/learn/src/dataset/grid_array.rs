//! Arrays in a grid: every scene has a row of each pixel, whose distance is its own.

use rayon::prelude::*;

use tofsim::scenario::Scenario;
use tofsim::sim::setup::array::ArraySetup;

/// Pixels of the scenes of a grid, by row, then column.
#[derive(Clone, Debug, PartialEq)]
pub struct GridArray {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// True depths of the pixels, by setting, then pixel; none until [`GridArray::with_depths`].
    depths: Vec<PixelDepth>,
}

/// Mean distance of what returns a pixel's light, along its line of sight; `None` if nothing does.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PixelDepth {
    /// From surfaces that reflect diffusely [m].
    diffuse_m: Option<f64>,
    /// From surfaces with a reflectance of 0, which may be retroreflective [m].
    black_m: Option<f64>,
}

impl GridArray {
    /// Returns the pixels of a scenario; `None` for a single one.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let (rows, columns) = (scenario.array.rows as usize, scenario.array.columns as usize);
        (rows * columns > 1).then(|| GridArray { rows, columns, depths: Vec::new() })
    }

    /// With the true depths of the pixels in each setting of the grid, on all threads of the current pool.
    pub fn with_depths<'a>(self, settings: impl Iterator<Item = &'a ArraySetup>) -> Self {
        let of_setting = |array: &'a ArraySetup| -> Vec<PixelDepth> {
            let depth = |pixel| {
                let [row, column] = self.place(pixel);
                let white = array.white(row, column);
                let black_m = white.of_white(0.0, 0.0).mean_radial_m();
                PixelDepth { diffuse_m: white.mean_radial_m(), black_m }
            };
            (0..self.count()).into_par_iter().map(depth).collect()
        };
        let depths = settings.flat_map(of_setting).collect();
        GridArray { depths, ..self }
    }

    /// Returns the number of pixels.
    pub fn count(&self) -> usize {
        self.rows * self.columns
    }

    /// Returns the row and the column of a pixel.
    pub fn place(&self, pixel: usize) -> [usize; 2] {
        [pixel / self.columns, pixel % self.columns]
    }

    /// Returns the true depth of a pixel in a setting, of surfaces with a reflectance; NaN if none of the laser's light
    /// returns [m].
    pub fn depth_m(&self, setting: usize, pixel: usize, reflectance: f64) -> f64 {
        let depth = self.depths.get(setting * self.count() + pixel);
        let of = |depth: &PixelDepth| match reflectance > 0.0 {
            true => depth.diffuse_m,
            false => depth.black_m,
        };
        depth.and_then(of).unwrap_or(f64::NAN)
    }

    /// Returns the least and the largest true depth; NaN without any [m].
    pub fn range_m(&self) -> [f64; 2] {
        let depths = || self.depths.iter().filter_map(|depth| depth.diffuse_m);
        [depths().fold(f64::NAN, f64::min), depths().fold(f64::NAN, f64::max)]
    }
}
