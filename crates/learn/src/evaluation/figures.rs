//! Figures of one estimator in an evaluation.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::dataset::Grid;

use super::by_pixel::{PixelSpread, SceneImages, by_pixel, images};
use super::by_scene::{SceneErrors, by_scene, most_biased};
use super::by_setting::{KeyGroups, by_setting};
use super::errors::{EstimatorErrors, Evaluation};
use super::spread::{Group, Spread};
use super::thesis;

/// Errors of one estimator, all and in groups.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Name on the command line.
    pub name: &'static str,
    /// All of them.
    pub all: Spread,
    /// By distance of the target [m].
    pub by_distance_m: Vec<Group>,
    /// By reflectance of the target [1].
    pub by_reflectance: Vec<Group>,
    /// By spectral irradiance of the target [W/m^2/nm].
    pub by_irradiance_w_m2_nm: Vec<Group>,
    /// By the other keys of the grid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_key: Vec<KeyGroups>,
    /// By pixel, of an array.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_pixel: Vec<PixelSpread>,
    /// Depth images of each scene, of an array whose pixels all have the same number of histograms.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub images: Vec<SceneImages>,
    /// By scene.
    #[serde(skip)]
    pub by_scene: Vec<SceneErrors>,
    /// The scene with the largest mean error, of those that came several times.
    pub most_biased_scene: Option<BiasedScene>,
    /// Spread over the line between the thesis's float figures, where that is largest [1].
    pub worst_ratio_to_thesis: Option<f64>,
    /// Distance of the worst error [m].
    pub worst_distance_m: Option<f64>,
}

/// A scene, and what estimates of it are off by.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BiasedScene {
    /// Distance of the target [m].
    pub distance_m: f64,
    /// Its reflectance [1].
    pub reflectance: f64,
    /// Its spectral irradiance [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
    /// Row and column of the pixel, of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel: Option<[usize; 2]>,
    /// Values of the other keys of the grid.
    #[serde(flatten)]
    pub keys: BTreeMap<String, f64>,
    /// Estimates of it.
    pub estimates: u64,
    /// Their mean error [mm].
    pub mean_mm: f64,
    /// Its standard error [mm].
    pub mean_se_mm: f64,
}

/// A quantity that errors are grouped by.
#[derive(Clone, Copy, Debug)]
pub struct Grouping<'a> {
    /// Its name, with the unit as keys have it.
    pub key: &'a str,
    /// In words, with the unit.
    pub quantity: &'a str,
    /// The groups.
    pub groups: &'a [Group],
}

impl Figures {
    /// Of a column of an evaluation; what is further off than `limit_m` is an outlier [m].
    pub fn new(evaluation: &Evaluation, column: &EstimatorErrors, limit_m: f64) -> Self {
        let by_distance_m = evaluation.by(column, |scene| scene.distance_m, limit_m);
        let worst = worst(&by_distance_m);
        let by_scene = by_scene(evaluation, column, limit_m);
        Figures {
            by_key: Vec::new(),
            by_pixel: Vec::new(),
            images: Vec::new(),
            most_biased_scene: most_biased(&by_scene).and_then(biased),
            by_scene,
            name: column.name,
            all: evaluation.all(column, limit_m),
            by_reflectance: evaluation.by(column, |scene| scene.reflectance, limit_m),
            by_irradiance_w_m2_nm: evaluation.by(column, |scene| scene.irradiance_w_m2_nm, limit_m),
            worst_ratio_to_thesis: worst.map(|(_, ratio)| ratio),
            worst_distance_m: worst.map(|(distance_m, _)| distance_m),
            by_distance_m,
        }
    }

    /// The same over a grid, with the errors by its other keys; the thesis's line is for the thesis's grid.
    pub fn over(
        evaluation: &Evaluation,
        column: &EstimatorErrors,
        grid: &Grid,
        limit_m: f64,
    ) -> Self {
        let mut figures = Figures::new(evaluation, column, limit_m);
        if let Some(array) = &grid.array {
            figures = figures.of_array(evaluation, column, [array.rows, array.columns], limit_m);
            for one in &mut figures.images {
                let keys = grid.setting(one.setting).into_iter();
                one.keys = keys.map(|(key, value)| (key.to_owned(), value)).collect();
            }
        }
        if !grid.is_thesis() {
            (figures.worst_ratio_to_thesis, figures.worst_distance_m) = (None, None);
        }
        if let (Some(shown), Some(worst)) =
            (&mut figures.most_biased_scene, most_biased(&figures.by_scene))
        {
            let keys = grid.setting(worst.scene.setting).into_iter();
            shown.keys = keys.map(|(key, value)| (key.to_owned(), value)).collect();
        }
        Figures { by_key: by_setting(evaluation, column, grid, limit_m), ..figures }
    }

    /// The same of an array with so many rows and columns, whose pixels take the place of distances.
    pub fn of_array(
        mut self,
        evaluation: &Evaluation,
        column: &EstimatorErrors,
        size: [usize; 2],
        limit_m: f64,
    ) -> Self {
        let by_pixel = by_pixel(evaluation, column, size, limit_m);
        if let (Some(shown), Some(worst)) =
            (&mut self.most_biased_scene, most_biased(&self.by_scene))
        {
            shown.pixel = by_pixel.get(worst.scene.pixel).map(|of| [of.row, of.column]);
        }
        let images = images(evaluation, column, size, limit_m);
        Figures { by_distance_m: Vec::new(), by_pixel, images, ..self }
    }

    /// Errors at a distance of the grid [m].
    pub fn at(&self, distance_m: f64) -> Option<&Spread> {
        let mut groups = self.by_distance_m.iter();
        groups.find(|group| group.value == distance_m).map(|group| &group.spread)
    }

    /// The distances where the spread is above the line between the thesis's float figures.
    pub fn distances_above_the_line(&self) -> usize {
        self.by_distance_m.iter().filter(|group| ratio(group) > Some(1.0)).count()
    }

    /// All ways in which the errors are grouped by one quantity.
    pub fn groupings(&self) -> Vec<Grouping<'_>> {
        let grouping = |key, quantity, groups| Grouping { key, quantity, groups };
        let of_scene = [
            grouping("distance_m", "distance [m]", &self.by_distance_m[..]),
            grouping("reflectance", "reflectance", &self.by_reflectance),
            grouping("irradiance_w_m2_nm", "irradiance [W/m^2/nm]", &self.by_irradiance_w_m2_nm),
        ];
        let by_key = self.by_key.iter();
        of_scene
            .into_iter()
            .chain(by_key.map(|of| grouping(&of.key, &of.key, &of.groups)))
            .collect()
    }
}

fn biased(SceneErrors { scene, spread }: &SceneErrors) -> Option<BiasedScene> {
    Some(BiasedScene {
        distance_m: scene.distance_m,
        reflectance: scene.reflectance,
        irradiance_w_m2_nm: scene.irradiance_w_m2_nm,
        pixel: None,
        keys: BTreeMap::new(),
        estimates: spread.estimates,
        mean_mm: spread.mean_mm?,
        mean_se_mm: spread.mean_se_mm?,
    })
}

/// The distance at which the spread is largest beside the line, and how large [m, 1].
fn worst(by_distance_m: &[Group]) -> Option<(f64, f64)> {
    let ratios = by_distance_m.iter().filter_map(|group| Some((group.value, ratio(group)?)));
    ratios.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Spread over that of the line.
fn ratio(group: &Group) -> Option<f64> {
    group.spread.two_sd_mm.map(|two_sd_mm| two_sd_mm / thesis::line_two_sd_mm(group.value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::Scene;

    #[test]
    fn the_worst_distance_is_the_one_farthest_above_the_line() {
        let (mut scenes, mut errors_m) = (Vec::new(), Vec::new());
        for (distance_m, two_sd_mm) in [(0.1, 1.7), (0.35, 3.0), (0.6, 5.0)] {
            for sign in [-1.0, 1.0] {
                scenes.push(Scene { distance_m, reflectance: 0.3, ..Scene::default() });
                errors_m.push(Some(sign * two_sd_mm / 2e3 / 2f64.sqrt()));
            }
        }
        let column = EstimatorErrors { name: "network", errors_m, ..EstimatorErrors::default() };
        let evaluation = Evaluation { scenes, columns: vec![column.clone()] };
        let figures = Figures::new(&evaluation, &column, 0.1);
        assert_eq!(figures.worst_distance_m, Some(0.1));
        assert!((figures.worst_ratio_to_thesis.unwrap() - 1.7 / 1.6).abs() < 1e-9);
        assert_eq!(figures.distances_above_the_line(), 2);
        let counts: Vec<_> = figures.groupings().iter().map(|of| of.groups.len()).collect();
        assert_eq!(counts, [3, 1, 1]);
    }
}
