//! Statistics of the depth images of an array.

use tofsim::sim::image::{Pixel, PixelFrame};
use tofsim::sim::setup::array::ArraySetup;

pub use tofsim::sim::image::ends_and_median;

use crate::figure::{Figure, mean};

/// Depth images of an array.
pub struct Images {
    /// The array.
    pub array: ArraySetup,
    /// Its pixels, by row, then column.
    pub pixels: Vec<Pixel>,
    /// Error above which a depth is an outlier [m].
    pub limit_m: f64,
}

/// Mean and variance of a pixel's errors over several images, in which it has a valid depth [mm].
struct PixelErrors {
    mean: f64,
    variance: f64,
    count: f64,
}

impl Images {
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
        let pixels = self.pixels.len() as f64;
        self.mean_of_images(|image| Some(self.valid(image).count() as f64 / pixels))
    }

    /// Returns the part of the valid depths between fore- and background: between the least and the largest true depth
    /// of the pixel and its eight neighbours, and farther from both than an outlier [1].
    pub fn flying_rate(&self) -> Figure {
        let ends: Vec<_> = (0..self.pixels.len()).map(|place| self.surfaces_m(place)).collect();
        self.mean_of_images(|image| {
            let is_flying = |(place, frame): (usize, &PixelFrame)| {
                ends[place].is_some_and(|[near, far]| {
                    (near + self.limit_m..far - self.limit_m).contains(&frame.radial_m)
                })
            };
            let flying = self.valid(image).filter(|&one| is_flying(one)).count();
            let valid = self.valid(image).count();
            (valid > 0).then(|| flying as f64 / valid as f64)
        })
    }

    /// Returns the root of the mean squared error of the valid depths [mm].
    pub fn root_mse(&self) -> Figure {
        let mse = self.mean_of_images(|image| mean(self.squares_mm2(image).into_iter()).value);
        let value = mse.value.map(f64::sqrt);
        let se =
            mse.se.zip(value).map(|(se, root)| if root > 0.0 { se / (2.0 * root) } else { 0.0 });
        Figure::new(value, se)
    }

    /// Returns the root mean square over the pixels of their mean error, without what noise contributes [mm].
    pub fn bias_by_pixel(&self) -> Figure {
        let square = |one: &PixelErrors| one.mean * one.mean - one.variance / one.count;
        let squares: Vec<_> = self.errors_by_pixel().iter().map(square).collect();
        Figure::new(mean(squares.into_iter()).value.map(|square| square.max(0.0).sqrt()), None)
    }

    /// Returns the root mean square over the pixels of the standard deviation of their depths [mm].
    pub fn sd_by_pixel(&self) -> Figure {
        let variances: Vec<_> = self.errors_by_pixel().iter().map(|one| one.variance).collect();
        Figure::new(mean(variances.into_iter()).value.map(f64::sqrt), None)
    }

    /// Returns the median standard deviation that the estimator states of a valid depth [mm].
    pub fn median_sigma(&self) -> Figure {
        self.mean_of_images(|image| {
            median(self.valid(image).filter_map(|(_, frame)| Some(1e3 * frame.sigma_m?)))
        })
    }

    /// Returns the root mean square of the errors over the standard deviations that the estimator states of them [1].
    pub fn error_over_sigma(&self) -> Figure {
        let mean_square = self.mean_of_images(|image| {
            let ratio = |(place, frame): (usize, &PixelFrame)| {
                Some((self.error_mm(place, frame)? / (1e3 * frame.sigma_m?)).powi(2))
            };
            let ratios: Vec<_> = self.valid(image).filter_map(ratio).collect();
            mean(ratios.into_iter()).value
        });
        Figure::new(mean_square.value.map(f64::sqrt), None)
    }

    /// Returns the mean over the images of a value of each.
    fn mean_of_images(&self, value: impl Fn(usize) -> Option<f64>) -> Figure {
        let images = self.pixels.first().map_or(0, |pixel| pixel.frames.len());
        let values: Vec<_> = (0..images).filter_map(value).collect();
        mean(values.into_iter())
    }

    /// Returns the valid depths of an image with the places of their pixels.
    fn valid(&self, image: usize) -> impl Iterator<Item = (usize, &PixelFrame)> {
        let frames = self.pixels.iter().map(move |pixel| &pixel.frames[image]);
        frames.enumerate().filter(|(_, frame)| frame.valid)
    }

    fn error_mm(&self, place: usize, frame: &PixelFrame) -> Option<f64> {
        Some(1e3 * (frame.radial_m - self.pixels[place].expected.radial_m?))
    }

    fn squares_mm2(&self, image: usize) -> Vec<f64> {
        let square = |(place, frame)| Some(self.error_mm(place, frame)?.powi(2));
        self.valid(image).filter_map(square).collect()
    }

    /// Returns the least and the largest true depth of a pixel and its eight neighbours [m].
    fn surfaces_m(&self, place: usize) -> Option<[f64; 2]> {
        let [rows, columns] = self.array.size();
        let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let [row, column] = [place / columns, place % columns];
        let places = around(row, rows)
            .flat_map(|row| around(column, columns).map(move |column| row * columns + column));
        let depths = places.filter_map(|place| self.pixels[place].expected.radial_m);
        depths.fold(None, |ends, depth| {
            let [near, far] = ends.unwrap_or([depth; 2]);
            Some([depth.min(near), depth.max(far)])
        })
    }

    /// Returns the errors of the pixels that are valid in two images at least.
    fn errors_by_pixel(&self) -> Vec<PixelErrors> {
        let of_pixel = |(place, pixel): (usize, &Pixel)| {
            let valid = pixel.frames.iter().filter(|frame| frame.valid);
            let errors: Vec<_> = valid.filter_map(|frame| self.error_mm(place, frame)).collect();
            let count = errors.len() as f64;
            let mean = errors.iter().sum::<f64>() / count;
            let squares = errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>();
            (count > 1.0).then(|| PixelErrors { mean, variance: squares / (count - 1.0), count })
        };
        self.pixels.iter().enumerate().filter_map(of_pixel).collect()
    }
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    ends_and_median(values).map(|[_, median, _]| median)
}

#[cfg(test)]
mod tests;
