//! JSON objects of images, for browsers.

use std::slice;
use std::sync::Arc;

use serde::Serialize;

use tofsim::firmware::tof_top::status::StatusSet;
use tofsim_learn::evaluation::images::{ImageDepths, PixelDepths};
use tofsim_learn::evaluation::spread::OUTLIER_M;

use super::super::scene::Slider;
use super::simulation::Image;

/// Schema version of the state.
pub const SCHEMA: &str = "tofsim.page_array/1";
/// Schema version of an image.
const IMAGE_SCHEMA: &str = "tofsim.page_image/1";

/// Complete state.
#[derive(Clone, Debug, Serialize)]
pub struct ArrayView<'a> {
    /// Schema version, [`SCHEMA`].
    pub schema: &'static str,
    /// Number of the state, which increases.
    pub version: u64,
    /// Name of the scenario.
    pub scenario: &'a str,
    /// Seed of all random streams.
    pub seed: u64,
    /// Simulation fidelity.
    pub fidelity: &'static str,
    /// Estimator of the firmware.
    pub estimator: &'static str,
    /// Size of the array.
    pub array: SizeView,
    /// Whether images are being simulated.
    pub running: bool,
    /// Error that stopped the run.
    pub fault: Option<&'a str>,
    /// Sliders of the scene.
    pub scene: Vec<Slider>,
    /// Whether the scene has changed, and no image of the new scene has ended yet.
    pub scene_coming: bool,
    /// Last complete image.
    pub image: Option<&'a SummaryView>,
    /// Progress of the present image.
    pub progress: ProgressView,
    /// Notes on the last image.
    pub notes: &'a [String],
    /// Simulation speed.
    pub time: TimeView,
}

/// Size of an array.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SizeView {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
}

/// A complete image without its pixels.
#[derive(Clone, Debug, Serialize)]
pub struct SummaryView {
    /// Number of the restart that it comes after.
    pub restart: u64,
    /// Number of the image, from 0.
    pub number: u64,
    /// Hash of its scenario.
    pub hash: String,
    /// Number of pixels with a valid depth.
    pub valid_pixels: usize,
    /// Part of the pixels with a valid depth [1].
    pub fill_rate: f64,
    /// Median standard deviation of the valid depths, if the estimator states one [m].
    pub median_sigma_m: Option<f64>,
    /// Command that gives the images up to this one.
    pub command: String,
}

/// Progress of an image.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ProgressView {
    /// Number of simulated pixels.
    pub pixels: u64,
    /// Number of pixels in an image.
    pub of: usize,
}

/// Simulation speed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TimeView {
    /// Number of images since the last restart.
    pub images: u64,
    /// Images per second in the simulation, recently.
    pub images_per_s: Option<f64>,
    /// Images per second of the firmware, if it can scan the array.
    pub firmware_images_per_s: Option<f64>,
    /// Time spent on the simulation since the last restart [s].
    pub here_s: f64,
}

/// An image with its pixels, by row, then column.
#[derive(Clone, Debug, Serialize)]
pub struct ImageView<'a> {
    schema: &'static str,
    #[serde(flatten)]
    summary: &'a SummaryView,
    #[serde(flatten)]
    size: SizeView,
    /// Estimated distances along the line of sight, valid or not [m].
    depth_m: Vec<f64>,
    /// Their standard deviations, from an estimator that states one [m].
    sigma_m: Vec<Option<f64>>,
    valid: Vec<bool>,
    /// Reasons to reject a depth, in words.
    status: Vec<StatusSet>,
    hits: Vec<u64>,
    /// Expected hits of laser photons, and other hits.
    signal_hits: Vec<Option<f64>>,
    ambient_hits: Vec<Option<f64>>,
    /// True distances along the line of sight [m].
    true_m: Vec<Option<f64>>,
}

impl SummaryView {
    /// Summarises an image.
    pub fn of(image: &Image, size: [usize; 2], restart: u64, command: String) -> Self {
        let pixels = image.expected.iter().zip(&image.frames);
        let pixels =
            pixels.map(|(expected, frame)| PixelDepths::of(expected, slice::from_ref(frame)));
        let depths = ImageDepths::new(size, pixels.collect(), OUTLIER_M);
        SummaryView {
            restart,
            number: image.number,
            hash: image.hash.to_string(),
            valid_pixels: depths.valid(0).count(),
            fill_rate: depths.fill_rate(0),
            median_sigma_m: depths.median_sigma_m(0),
            command,
        }
    }
}

impl<'a> ImageView<'a> {
    /// Sorts an image by what its pixels have.
    pub fn of(image: &Image, summary: &'a SummaryView, [rows, columns]: [usize; 2]) -> Self {
        let Image { frames, expected, .. } = image;
        ImageView {
            schema: IMAGE_SCHEMA,
            summary,
            size: SizeView { rows, columns },
            depth_m: each(frames, |frame| frame.radial_m),
            sigma_m: each(frames, |frame| frame.sigma_m),
            valid: each(frames, |frame| frame.valid),
            status: each(frames, |frame| frame.status),
            hits: each(frames, |frame| frame.hits),
            signal_hits: each(expected, |pixel| pixel.signal_hits),
            ambient_hits: each(expected, |pixel| pixel.ambient_hits),
            true_m: each(expected, |pixel| pixel.radial_m),
        }
    }

    /// Returns the image as JSON.
    pub fn json(&self) -> Arc<str> {
        serde_json::to_string(self).unwrap_or_default().into()
    }
}

/// Returns a value of each pixel.
fn each<P, T>(pixels: &[P], value: impl Fn(&P) -> T) -> Vec<T> {
    pixels.iter().map(value).collect()
}
