//! Errors on an array: pixel by pixel, and of the depth images of each scene.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::dataset::Scene;

use super::errors::{EstimatorErrors, Evaluation};
use super::images::{ImageDepths, PixelDepths, RadialDepth};
use super::spread::Spread;

/// Errors of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelSpread {
    /// Row, from the top.
    pub row: usize,
    /// Column, from the left.
    pub column: usize,
    /// Its errors in all scenes.
    #[serde(flatten)]
    pub spread: Spread,
}

/// Statistics of the depth images of a scene: each has the n-th histogram of every pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneImages {
    /// Index of the values of the grid's other keys.
    #[serde(skip)]
    pub setting: usize,
    /// Reflectance of the target [1].
    pub reflectance: f64,
    /// Its spectral irradiance [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
    /// Values of the other keys of the grid.
    #[serde(flatten)]
    pub keys: BTreeMap<String, f64>,
    /// Number of images.
    pub images: usize,
    /// Part of the pixels with an estimate [1].
    pub fill_rate: f64,
    /// Standard error of that, of two images at least [1].
    pub fill_rate_se: Option<f64>,
    /// Part of the estimates between fore- and background [1].
    pub flying_rate: Option<f64>,
    /// Standard error of that [1].
    pub flying_rate_se: Option<f64>,
    /// Root of the mean squared error of the estimates [mm].
    pub root_mse_mm: Option<f64>,
    /// Root mean square over the pixels of their mean error, without what noise contributes; takes two images [mm].
    pub bias_by_pixel_mm: Option<f64>,
    /// Root mean square over the pixels of the standard deviation of their estimates; takes two images [mm].
    pub sd_by_pixel_mm: Option<f64>,
}

/// Returns the errors of a column by pixel of an array with so many rows and columns, by row, then column; what is
/// further off than `limit_m` is an outlier [m].
pub fn by_pixel(
    evaluation: &Evaluation,
    column: &EstimatorErrors,
    [rows, columns]: [usize; 2],
    limit_m: f64,
) -> Vec<PixelSpread> {
    let mut errors_m = vec![Vec::new(); rows * columns];
    for known in evaluation.known(column) {
        errors_m[known.scene.pixel].push((known.error_m, known.truth_m));
    }
    let of_pixel = |(pixel, errors_m)| PixelSpread {
        row: pixel / columns,
        column: pixel % columns,
        spread: Spread::judged(errors_m, limit_m),
    };
    errors_m.into_iter().enumerate().map(of_pixel).collect()
}

/// Returns the statistics of the images of each scene, in the order of the rows; none where pixels have different
/// numbers of histograms.
pub fn images(
    evaluation: &Evaluation,
    column: &EstimatorErrors,
    size: [usize; 2],
    limit_m: f64,
) -> Vec<SceneImages> {
    let [rows, columns] = size;
    let mut scenes: Vec<(SceneImages, Vec<PixelDepths>)> = Vec::new();
    let mut places = BTreeMap::new();
    for (scene, depth_m) in evaluation.scenes.iter().zip(&column.depths_m) {
        let light = [scene.reflectance, scene.irradiance_w_m2_nm].map(f64::to_bits);
        let place = *places.entry((scene.setting, light)).or_insert_with(|| {
            let pixels = vec![PixelDepths::default(); rows * columns];
            scenes.push((SceneImages::of(scene), pixels));
            scenes.len() - 1
        });
        let pixel = &mut scenes[place].1[scene.pixel];
        pixel.true_m = Some(scene.distance_m).filter(|distance_m| !distance_m.is_nan());
        pixel.depths.push(depth_m.map(|radial_m| RadialDepth { radial_m, sigma_m: None }));
    }
    let all = scenes.into_iter().map(|(scene, pixels)| {
        let images = pixels[0].depths.len();
        let is_whole = images > 0 && pixels.iter().all(|pixel| pixel.depths.len() == images);
        is_whole.then(|| scene.measured(&ImageDepths::new(size, pixels, limit_m)))
    });
    all.collect::<Option<_>>().unwrap_or_default()
}

impl SceneImages {
    fn of(scene: &Scene) -> Self {
        SceneImages {
            setting: scene.setting,
            reflectance: scene.reflectance,
            irradiance_w_m2_nm: scene.irradiance_w_m2_nm,
            keys: BTreeMap::new(),
            images: 0,
            fill_rate: 0.0,
            fill_rate_se: None,
            flying_rate: None,
            flying_rate_se: None,
            root_mse_mm: None,
            bias_by_pixel_mm: None,
            sd_by_pixel_mm: None,
        }
    }

    fn measured(self, images: &ImageDepths) -> Self {
        let (fill_rate, fill_rate_se) = images.mean_of(|image| Some(images.fill_rate(image)));
        let (flying_rate, flying_rate_se) = images.mean_of(|image| images.flying_rate(image));
        let (mean_square, _) = images.mean_of(|image| images.mean_square_mm2(image));
        SceneImages {
            images: images.count(),
            fill_rate: fill_rate.unwrap_or_default(),
            fill_rate_se,
            flying_rate,
            flying_rate_se,
            root_mse_mm: mean_square.map(f64::sqrt),
            bias_by_pixel_mm: images.bias_by_pixel_mm(),
            sd_by_pixel_mm: images.sd_by_pixel_mm(),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pixels, of which the second has no distance, with two histograms in each of two settings.
    fn evaluation() -> (Evaluation, EstimatorErrors) {
        let mut column = EstimatorErrors { name: "likelihood", ..EstimatorErrors::default() };
        let mut scenes = Vec::new();
        let depths_m = [Some(0.301), Some(0.303), None, Some(0.9), Some(0.299), None, None, None];
        for (k, depth_m) in depths_m.into_iter().enumerate() {
            let (setting, pixel) = (k / 4, k / 2 % 2);
            let distance_m = [0.3, f64::NAN][pixel];
            scenes.push(Scene { distance_m, setting, pixel, ..Scene::default() });
            column.depths_m.push(depth_m);
            column.errors_m.push(depth_m.map(|m| m - distance_m));
        }
        (Evaluation { scenes, columns: vec![column.clone()] }, column)
    }

    fn near(found: Option<f64>, expected: f64) {
        assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?} for {expected}");
    }

    #[test]
    fn images_have_the_nth_histogram_of_every_pixel() {
        let (evaluation, column) = evaluation();
        let scenes = images(&evaluation, &column, [1, 2], 0.1);
        let [first, second] = &scenes[..] else { panic!("{scenes:?}") };
        assert_eq!((first.setting, first.images, second.setting), (0, 2, 1));
        // The second pixel's depth counts, though it has no error.
        near(Some(first.fill_rate), 0.75);
        near(first.root_mse_mm, 5f64.sqrt());
        near(first.sd_by_pixel_mm, 2f64.sqrt());
        near(first.bias_by_pixel_mm, 3f64.sqrt());
        near(Some(second.fill_rate), 0.25);
        assert_eq!(second.bias_by_pixel_mm, None);
    }

    #[test]
    fn pixels_without_the_same_number_of_histograms_make_no_images() {
        let (mut evaluation, mut column) = evaluation();
        evaluation.scenes.pop();
        column.depths_m.pop();
        assert_eq!(images(&evaluation, &column, [1, 2], 0.1), []);
    }

    #[test]
    fn errors_by_pixel_are_those_of_all_scenes_with_a_distance() {
        let (evaluation, column) = evaluation();
        let pixels = by_pixel(&evaluation, &column, [1, 2], 0.1);
        let found: Vec<_> = pixels.iter().map(|of| (of.row, of.column)).collect();
        assert_eq!(found, [(0, 0), (0, 1)]);
        near(pixels[0].spread.mean_mm, 1.0);
        assert_eq!((pixels[0].spread.estimates, pixels[0].spread.failures), (3, 1));
        assert_eq!((pixels[1].spread.estimates, pixels[1].spread.failures), (0, 0));
    }
}
