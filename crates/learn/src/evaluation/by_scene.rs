//! Errors scene by scene: what a network is off by where distance, reflectance and light are all given.

use std::collections::BTreeMap;

use crate::dataset::Scene;

use super::errors::{EstimatorErrors, Evaluation};
use super::spread::Spread;

/// The errors in one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors {
    /// The scene.
    pub scene: Scene,
    /// Errors of all histograms of it.
    pub spread: Spread,
}

/// The errors of a column in each scene, in rising order of setting, pixel, distance, reflectance and light; what
/// is further off than `limit_m` is an outlier [m].
pub fn by_scene(
    evaluation: &Evaluation,
    column: &EstimatorErrors,
    limit_m: f64,
) -> Vec<SceneErrors> {
    let mut rows: BTreeMap<_, (Scene, Vec<_>)> = BTreeMap::new();
    for known in evaluation.known(column) {
        let (_, judged) = rows.entry(known.scene.key()).or_insert((*known.scene, Vec::new()));
        judged.push((known.error_m, known.truth_m));
    }
    let errors = |(scene, judged)| SceneErrors { scene, spread: Spread::judged(judged, limit_m) };
    rows.into_values().map(errors).collect()
}

/// The scene with the largest mean error, of those with several estimates.
pub fn most_biased(scenes: &[SceneErrors]) -> Option<&SceneErrors> {
    let bias = |of: &SceneErrors| of.spread.mean_mm.map_or(0.0, f64::abs);
    let several = scenes.iter().filter(|of| of.spread.mean_se_mm.is_some());
    several.max_by(|a, b| bias(a).total_cmp(&bias(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_in_order_and_the_most_biased_has_several_estimates() {
        let scene = |distance_m, setting| Scene {
            distance_m,
            reflectance: 0.3,
            setting,
            ..Scene::default()
        };
        let rows = [
            (scene(0.2, 1), Some(0.009)),
            (scene(0.3, 0), Some(-0.002)),
            (scene(0.1, 0), Some(0.001)),
            (scene(0.3, 0), Some(-0.004)),
            (scene(0.1, 0), None),
            (scene(0.1, 0), Some(0.002)),
        ];
        let (scenes, errors_m): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
        let column = EstimatorErrors { name: "network", errors_m, ..EstimatorErrors::default() };
        let evaluation = Evaluation { scenes, columns: vec![column.clone()] };
        let found = by_scene(&evaluation, &column, 0.1);
        let order: Vec<_> = found.iter().map(|of| of.scene).collect();
        assert_eq!(order, [scene(0.1, 0), scene(0.3, 0), scene(0.2, 1)]);
        assert_eq!((found[0].spread.estimates, found[0].spread.failures), (2, 1));
        let worst = most_biased(&found).unwrap();
        assert_eq!(worst.scene, scene(0.3, 0));
        assert!((worst.spread.mean_mm.unwrap() + 3.0).abs() < 1e-9);
        assert!(most_biased(&found[2..]).is_none());
    }
}
