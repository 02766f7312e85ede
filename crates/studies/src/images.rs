//! Columns of an array's depth images: [`ImageDepths`] has the statistics.

use tofsim::sim::image::{Pixel, ends_and_median};
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::evaluation::images::{ImageDepths, PixelDepths};

use crate::figure::Figure;

/// Depth images of an array.
pub struct Images {
    /// The array.
    pub array: ArraySetup,
    /// Its pixels, by row, then column.
    pub pixels: Vec<Pixel>,
    depths: ImageDepths,
}

impl Images {
    /// Of the pixels of an array, by row, then column; a depth with a larger error than `limit_m` is an outlier [m].
    pub fn new(array: ArraySetup, pixels: Vec<Pixel>, limit_m: f64) -> Self {
        let depths = pixels.iter().map(|pixel| PixelDepths::of(&pixel.expected, &pixel.frames));
        let depths = ImageDepths::new(array.size(), depths.collect(), limit_m);
        Images { array, pixels, depths }
    }

    /// Returns the image rate of the firmware that scans the array, if it can [1/s].
    pub fn rate(&self) -> Figure {
        let cycle_s = self.array.common().cycle().seconds();
        let timing = self.array.timing().ok();
        Figure::new(timing.map(|timing| 1.0 / (timing.image as f64 * cycle_s)), None)
    }

    /// Returns the median over the pixels of what each can expect.
    pub fn expected(&self, of: fn(&Pixel) -> Option<f64>) -> Figure {
        Figure::new(median(self.pixels.iter().filter_map(of)), None)
    }

    /// Returns the part of the pixels with a valid depth [1].
    pub fn fill_rate(&self) -> Figure {
        self.mean_of(|image| Some(self.depths.fill_rate(image)))
    }

    /// Returns the part of the valid depths between fore- and background [1].
    pub fn flying_rate(&self) -> Figure {
        self.mean_of(|image| self.depths.flying_rate(image))
    }

    /// Returns the root of the mean squared error of the valid depths [mm].
    pub fn root_mse(&self) -> Figure {
        let mse = self.mean_of(|image| self.depths.mean_square_mm2(image));
        let value = mse.value.map(f64::sqrt);
        let se =
            mse.se.zip(value).map(|(se, root)| if root > 0.0 { se / (2.0 * root) } else { 0.0 });
        Figure::new(value, se)
    }

    /// Returns the root mean square over the pixels of their mean error, without what noise contributes [mm].
    pub fn bias_by_pixel(&self) -> Figure {
        Figure::new(self.depths.bias_by_pixel_mm(), None)
    }

    /// Returns the root mean square over the pixels of the standard deviation of their depths [mm].
    pub fn sd_by_pixel(&self) -> Figure {
        Figure::new(self.depths.sd_by_pixel_mm(), None)
    }

    /// Returns the median standard deviation that the estimator states of a valid depth [mm].
    pub fn median_sigma(&self) -> Figure {
        self.mean_of(|image| median(self.depths.sigmas_m(image).map(|sigma_m| 1e3 * sigma_m)))
    }

    /// Returns the root mean square of the errors over the standard deviations that the estimator states of them [1].
    pub fn error_over_sigma(&self) -> Figure {
        let mean_square = self.mean_of(|image| self.depths.mean_square_over_sigma(image));
        Figure::new(mean_square.value.map(f64::sqrt), None)
    }

    fn mean_of(&self, value: impl Fn(usize) -> Option<f64>) -> Figure {
        let (mean, se) = self.depths.mean_of(value);
        Figure::new(mean, se)
    }
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    ends_and_median(values).map(|[_, median, _]| median)
}

#[cfg(test)]
mod tests;
