//! Readings of an image's pixels.

use tofsim::sim::image::{Pixel, PixelFrame};
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::evaluation::images::{ImageDepths, PixelDepths};
use tofsim_learn::evaluation::spread::OUTLIER_M;

/// Simulated images of an array, or the part of them that one pixel sees.
pub struct DepthImages<'a> {
    /// The array.
    pub array: &'a ArraySetup,
    /// Name of the simulation fidelity.
    pub fidelity: &'static str,
    /// Number of images.
    pub images: u64,
    /// Path of the waveform.
    pub waves: Option<String>,
    /// All pixels by row, then column, or a single one.
    pub pixels: Vec<ImagePixel>,
}

/// A pixel of the images.
pub struct ImagePixel {
    /// Row, from the top.
    pub row: usize,
    /// Column, from the left.
    pub column: usize,
    /// Direction that it looks at, as a unit vector: to the right, down and forward [1].
    pub sight: [f64; 3],
    /// What it expects and what it measured.
    pub measured: Pixel,
}

impl ImagePixel {
    /// A pixel at a row and column.
    pub fn new(array: &ArraySetup, [row, column]: [usize; 2], measured: Pixel) -> Self {
        ImagePixel { row, column, sight: array.sight(row, column), measured }
    }

    /// All pixels of an array, which come by row, then column.
    pub fn all(array: &ArraySetup, pixels: Vec<Pixel>) -> Vec<Self> {
        let [_, columns] = array.size();
        let place = |(k, pixel)| ImagePixel::new(array, [k / columns, k % columns], pixel);
        pixels.into_iter().enumerate().map(place).collect()
    }
}

/// A pixel in one image.
#[derive(Clone, Copy)]
pub struct Reading<'a> {
    pub image: usize,
    pub pixel: &'a ImagePixel,
    pub frame: &'a PixelFrame,
}

impl Reading<'_> {
    /// Distance along the line of sight, if it is valid [m].
    pub fn radial_m(&self) -> Option<f64> {
        self.frame.valid.then_some(self.frame.radial_m)
    }

    /// Distance from the sensor's plane, if it is valid [m].
    pub fn perpendicular_m(&self) -> Option<f64> {
        Some(self.radial_m()? * self.pixel.sight[2])
    }

    /// Standard deviation of the distance, if that is valid and its estimator states one [m].
    pub fn sigma_m(&self) -> Option<f64> {
        self.frame.sigma_m.filter(|_| self.frame.valid)
    }

    /// Distance of a second target along the line of sight, if there is one [m].
    pub fn second_radial_m(&self) -> Option<f64> {
        self.frame.second.map(|second| second.depth_m)
    }

    /// Standard deviation of that [m].
    pub fn second_sigma_m(&self) -> Option<f64> {
        self.frame.second.map(|second| second.sigma_m)
    }

    /// Difference from the true distance, if there are both [m].
    pub fn error_m(&self) -> Option<f64> {
        Some(self.radial_m()? - self.pixel.measured.expected.radial_m?)
    }

    /// Place of what is seen: to the right, down and forward of the sensor [m].
    pub fn point(&self) -> Option<[f64; 3]> {
        let radial_m = self.radial_m()?;
        Some(self.pixel.sight.map(|part| radial_m * part))
    }
}

impl DepthImages<'_> {
    /// Returns whether there are all pixels, and not a single one of several.
    pub fn is_whole(&self) -> bool {
        let [rows, columns] = self.array.size();
        self.pixels.len() == rows * columns
    }

    /// Returns whether the firmware looks for a second target.
    pub fn looks_for_two(&self) -> bool {
        self.array.common().targets().has_second()
    }

    /// Returns the valid depths of all images; those of a single pixel as an array of one.
    pub fn depths(&self) -> ImageDepths {
        let size = if self.is_whole() { self.array.size() } else { [1, self.pixels.len()] };
        let measured = self.pixels.iter().map(|pixel| &pixel.measured);
        let pixels = measured.map(|pixel| PixelDepths::of(&pixel.expected, &pixel.frames));
        ImageDepths::new(size, pixels.collect(), OUTLIER_M)
    }

    /// Returns the readings of an image, by row, then column.
    pub fn image(&self, image: usize) -> impl Iterator<Item = Reading<'_>> {
        self.pixels.iter().filter_map(move |pixel| {
            Some(Reading { image, pixel, frame: pixel.measured.frames.get(image)? })
        })
    }

    /// Returns a value of each pixel in the first image.
    pub fn first(&self, value: impl Fn(&Reading) -> Option<f64>) -> Vec<Option<f64>> {
        self.image(0).map(|one| value(&one)).collect()
    }

    /// Returns the readings of all images, one after the other.
    pub fn readings(&self) -> Vec<Reading<'_>> {
        (0..self.images as usize).flat_map(|image| self.image(image)).collect()
    }
}
