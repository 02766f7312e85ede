//! Errors by the keys of a grid that are none of a scene's.

use serde::Serialize;

use crate::dataset::Grid;

use super::errors::{EstimatorErrors, Evaluation};
use super::spread::Group;

/// The errors of an estimator by a key of the grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeyGroups {
    /// The key, such as `laser.pulse_sigma_ps`.
    pub key: String,
    /// Errors by its value, in rising order.
    pub groups: Vec<Group>,
}

/// The errors of a column by each of the grid's other keys; what is further off than `limit_m` is an
/// outlier [m].
pub fn by_setting(
    evaluation: &Evaluation,
    column: &EstimatorErrors,
    grid: &Grid,
    limit_m: f64,
) -> Vec<KeyGroups> {
    let settings: Vec<_> = (0..grid.settings() as usize).map(|k| grid.setting(k)).collect();
    let of_key = |(place, axis): (usize, &crate::dataset::Axis)| {
        let mut groups = evaluation.by(column, |scene| settings[scene.setting][place].1, limit_m);
        groups.sort_by(|a, b| a.value.total_cmp(&b.value));
        KeyGroups { key: axis.key.clone(), groups }
    };
    grid.others.iter().enumerate().map(of_key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Axis, GridPurpose, Scene};

    #[test]
    fn errors_are_grouped_by_the_value_of_their_setting() {
        let axis = |option| Axis::parse("--grid", option).unwrap();
        let axes = [axis("estimator.centroid_offset_m=-0.5,0.5"), axis("spad.pdp=0.01,0.02,0.03")];
        let grid = Grid::own(&axes, &Default::default(), GridPurpose::Test).unwrap();
        let scenes: Vec<_> = (0..6).map(|setting| Scene { setting, ..Scene::default() }).collect();
        let errors_m = (0..6).map(|k| Some(1e-3 * f64::from(k))).collect();
        let column = EstimatorErrors { name: "network", errors_m, ..EstimatorErrors::default() };
        let evaluation = Evaluation { scenes, columns: vec![column.clone()] };
        let keys = by_setting(&evaluation, &column, &grid, 0.1);
        let means = |k: usize| {
            let groups = keys[k].groups.iter();
            groups.map(|group| (group.value, group.spread.mean_mm.unwrap())).collect::<Vec<_>>()
        };
        assert_eq!(keys[1].key, "spad.pdp");
        assert_eq!(means(0), [(-0.5, 1.0), (0.5, 4.0)]);
        assert_eq!(means(1), [(0.01, 1.5), (0.02, 2.5), (0.03, 3.5)]);
    }
}
