//! Statistics of an array's depth images: how many pixels have a depth, and how good these are.

use tofsim::sim::image::{Expected, PixelFrame, ends_and_median};

use super::spread::mean_and_error;

/// Valid depth of a pixel in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialDepth {
    /// Distance along the line of sight [m].
    pub radial_m: f64,
    /// Its standard deviation, from an estimator that states one [m].
    pub sigma_m: Option<f64>,
}

/// Depths of a pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelDepths {
    /// True depth; `None` where no light returns [m].
    pub true_m: Option<f64>,
    /// Depth in each image, if it is valid.
    pub depths: Vec<Option<RadialDepth>>,
}

/// Depths of an array's pixels in several images.
pub struct ImageDepths {
    pixels: Vec<PixelDepths>,
    /// Least and largest true depth of each pixel and its eight neighbours [m].
    surfaces_m: Vec<Option<[f64; 2]>>,
    /// Error above which a depth is an outlier [m].
    limit_m: f64,
}

/// Mean and variance of a pixel's errors over several images, in which it has a valid depth [mm].
struct PixelErrors {
    mean: f64,
    variance: f64,
    count: f64,
}

impl PixelDepths {
    /// Returns the true depth of a pixel and its valid depths in some images.
    pub fn of(expected: &Expected, frames: &[PixelFrame]) -> Self {
        let depth = |frame: &PixelFrame| {
            let PixelFrame { radial_m, sigma_m, .. } = *frame;
            frame.valid.then_some(RadialDepth { radial_m, sigma_m })
        };
        PixelDepths { true_m: expected.radial_m, depths: frames.iter().map(depth).collect() }
    }
}

impl ImageDepths {
    /// Of the pixels of an array with so many rows and columns, by row, then column; a depth with a larger error than
    /// `limit_m` is an outlier [m].
    pub fn new(size: [usize; 2], pixels: Vec<PixelDepths>, limit_m: f64) -> Self {
        let surfaces_m = (0..pixels.len()).map(|place| surfaces_m(size, &pixels, place)).collect();
        ImageDepths { pixels, surfaces_m, limit_m }
    }

    /// Returns the number of images.
    pub fn count(&self) -> usize {
        self.pixels.first().map_or(0, |pixel| pixel.depths.len())
    }

    /// Returns the mean over the images of a value of each, and its standard error.
    pub fn mean_of(&self, value: impl Fn(usize) -> Option<f64>) -> (Option<f64>, Option<f64>) {
        let values: Vec<_> = (0..self.count()).filter_map(value).collect();
        mean_and_error(values.into_iter())
    }

    /// Returns the valid depths of an image with the places of their pixels.
    pub fn valid(&self, image: usize) -> impl Iterator<Item = (usize, RadialDepth)> {
        let places = self.pixels.iter().enumerate();
        places.filter_map(move |(place, pixel)| Some((place, pixel.depths[image]?)))
    }

    /// Returns the part of the pixels that have a valid depth in an image [1].
    pub fn fill_rate(&self, image: usize) -> f64 {
        self.valid(image).count() as f64 / self.pixels.len() as f64
    }

    /// Returns the part of the valid depths of an image between fore- and background: between the least and the largest
    /// true depth of the pixel and its eight neighbours, and farther from both than an outlier [1].
    pub fn flying_rate(&self, image: usize) -> Option<f64> {
        let is_flying = |(place, depth): &(usize, RadialDepth)| {
            self.surfaces_m[*place].is_some_and(|[near, far]| {
                (near + self.limit_m..far - self.limit_m).contains(&depth.radial_m)
            })
        };
        let valid = self.valid(image).count();
        let flying = self.valid(image).filter(is_flying).count();
        (valid > 0).then(|| flying as f64 / valid as f64)
    }

    /// Returns the errors of the valid depths of an image [m].
    pub fn errors_m(&self, image: usize) -> impl Iterator<Item = f64> {
        self.valid(image).filter_map(|(place, depth)| self.error_m(place, depth))
    }

    /// Returns the mean squared error of the valid depths of an image [mm^2].
    pub fn mean_square_mm2(&self, image: usize) -> Option<f64> {
        let squares: Vec<_> = self.errors_m(image).map(|error_m| (1e3 * error_m).powi(2)).collect();
        mean_and_error(squares.into_iter()).0
    }

    /// Returns the standard deviations that the estimator states of the valid depths of an image [m].
    pub fn sigmas_m(&self, image: usize) -> impl Iterator<Item = f64> {
        self.valid(image).filter_map(|(_, depth)| depth.sigma_m)
    }

    /// Returns the median of these standard deviations [m].
    pub fn median_sigma_m(&self, image: usize) -> Option<f64> {
        ends_and_median(self.sigmas_m(image)).map(|[_, median, _]| median)
    }

    /// Returns the mean square of the errors of an image over the standard deviations that are stated of them [1].
    pub fn mean_square_over_sigma(&self, image: usize) -> Option<f64> {
        let ratio = |(place, depth): (usize, RadialDepth)| {
            Some((1e3 * self.error_m(place, depth)? / (1e3 * depth.sigma_m?)).powi(2))
        };
        let ratios: Vec<_> = self.valid(image).filter_map(ratio).collect();
        mean_and_error(ratios.into_iter()).0
    }

    /// Returns the root mean square over the pixels of their mean error, without what noise contributes [mm].
    pub fn bias_by_pixel_mm(&self) -> Option<f64> {
        let square = |one: &PixelErrors| one.mean * one.mean - one.variance / one.count;
        let squares: Vec<_> = self.errors_by_pixel().iter().map(square).collect();
        mean_and_error(squares.into_iter()).0.map(|square| square.max(0.0).sqrt())
    }

    /// Returns the root mean square over the pixels of the standard deviation of their depths [mm].
    pub fn sd_by_pixel_mm(&self) -> Option<f64> {
        let variances: Vec<_> = self.errors_by_pixel().iter().map(|one| one.variance).collect();
        mean_and_error(variances.into_iter()).0.map(f64::sqrt)
    }

    fn error_m(&self, place: usize, depth: RadialDepth) -> Option<f64> {
        Some(depth.radial_m - self.pixels[place].true_m?)
    }

    /// Returns the errors of the pixels that are valid in two images at least.
    fn errors_by_pixel(&self) -> Vec<PixelErrors> {
        let of_pixel = |(place, pixel): (usize, &PixelDepths)| {
            let valid = pixel.depths.iter().flatten();
            let errors = valid.filter_map(|&depth| Some(1e3 * self.error_m(place, depth)?));
            let errors: Vec<_> = errors.collect();
            let count = errors.len() as f64;
            let mean = errors.iter().sum::<f64>() / count;
            let squares = errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>();
            (count > 1.0).then(|| PixelErrors { mean, variance: squares / (count - 1.0), count })
        };
        self.pixels.iter().enumerate().filter_map(of_pixel).collect()
    }
}

/// Returns the least and the largest true depth of a pixel and its eight neighbours [m].
fn surfaces_m(
    [rows, columns]: [usize; 2],
    pixels: &[PixelDepths],
    place: usize,
) -> Option<[f64; 2]> {
    let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    let [row, column] = [place / columns, place % columns];
    let places = around(row, rows)
        .flat_map(|row| around(column, columns).map(move |column| row * columns + column));
    let depths = places.filter_map(|place| pixels.get(place)?.true_m);
    depths.fold(None, |ends, depth| {
        let [near, far] = ends.unwrap_or([depth; 2]);
        Some([depth.min(near), depth.max(far)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_depth_flies_between_the_surfaces_of_pixel_and_neighbours() {
        let depth = |radial_m| Some(RadialDepth { radial_m, sigma_m: None });
        let pixel =
            |true_m, radial_m| PixelDepths { true_m: Some(true_m), depths: vec![depth(radial_m)] };
        // Two rows of three: the surfaces differ between the columns 0 and 1.
        let near_and_far = |at: f64| {
            vec![
                pixel(0.3, 0.3),
                pixel(0.7, 0.7),
                pixel(0.7, at),
                pixel(0.3, at),
                pixel(0.7, 0.7),
                pixel(0.7, 0.7),
            ]
        };
        let of = |size, at| ImageDepths::new(size, near_and_far(at), 0.1).flying_rate(0).unwrap();
        assert_eq!(of([2, 3], 0.5), 1.0 / 6.0);
        // In three rows of two, both have a neighbour on the other surface.
        assert_eq!(of([3, 2], 0.5), 2.0 / 6.0);
        assert_eq!(of([2, 3], 0.35), 0.0);
    }
}
