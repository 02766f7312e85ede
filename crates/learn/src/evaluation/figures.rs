//! What an evaluation says of one estimator.

use serde::Serialize;

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
    /// Spread over the line between the thesis's float figures, where that is largest [1].
    pub worst_ratio_to_thesis: Option<f64>,
    /// Where that is [m].
    pub worst_distance_m: Option<f64>,
}

/// A quantity that errors are grouped by.
#[derive(Clone, Copy, Debug)]
pub struct Grouping<'a> {
    /// Its name, with the unit as keys have it.
    pub key: &'static str,
    /// In words, with the unit.
    pub quantity: &'static str,
    /// The groups.
    pub groups: &'a [Group],
}

impl Figures {
    /// Of a column of an evaluation; what is further off than `limit_m` is an outlier [m].
    pub fn new(evaluation: &Evaluation, column: &EstimatorErrors, limit_m: f64) -> Self {
        let by_distance_m = evaluation.by(column, |scene| scene.distance_m, limit_m);
        let worst = worst(&by_distance_m);
        Figures {
            name: column.name,
            all: evaluation.all(column, limit_m),
            by_reflectance: evaluation.by(column, |scene| scene.reflectance, limit_m),
            by_irradiance_w_m2_nm: evaluation.by(column, |scene| scene.irradiance_w_m2_nm, limit_m),
            worst_ratio_to_thesis: worst.map(|(_, ratio)| ratio),
            worst_distance_m: worst.map(|(distance_m, _)| distance_m),
            by_distance_m,
        }
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

    /// All ways in which the errors are grouped.
    pub fn groupings(&self) -> [Grouping<'_>; 3] {
        let grouping = |key, quantity, groups| Grouping { key, quantity, groups };
        [
            grouping("distance_m", "distance [m]", &self.by_distance_m[..]),
            grouping("reflectance", "reflectance", &self.by_reflectance),
            grouping("irradiance_w_m2_nm", "irradiance [W/m^2/nm]", &self.by_irradiance_w_m2_nm),
        ]
    }
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
        let column = EstimatorErrors { name: "network", errors_m };
        let evaluation = Evaluation { scenes, columns: vec![column.clone()] };
        let figures = Figures::new(&evaluation, &column, 0.1);
        assert_eq!(figures.worst_distance_m, Some(0.1));
        assert!((figures.worst_ratio_to_thesis.unwrap() - 1.7 / 1.6).abs() < 1e-9);
        assert_eq!(figures.distances_above_the_line(), 2);
        assert_eq!(figures.groupings().map(|grouping| grouping.groups.len()), [3, 1, 1]);
    }
}
