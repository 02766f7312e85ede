//! The Cramer-Rao bound over a grid: no unbiased estimator that does not know the light is better. It is worked out
//! for shots that are alike.

use rayon::prelude::*;

use tofsim::error::Input;
use tofsim::scenario::effects::Method;

use crate::dataset::blocks::Last;
use crate::dataset::source::scaled;
use crate::dataset::{Grid, HistogramSource, Scene};
use crate::estimation::likelihood::Model;

/// Lights at a distance that the mean is over; of more, every so many one.
const MOST_LIGHTS: u64 = 1024;

/// Twice the root mean square of the bound over the grid's lights at each distance; `None` where a
/// scene tells nothing, as without a laser, and where shots differ or their light is not of one or two echoes and a cover
/// window with a template [mm].
///
/// # Errors
/// When the acquisition of a setting makes no sense.
pub fn two_sd_mm(
    source: &HistogramSource,
    grid: &Grid,
    distances_m: &[f64],
) -> Result<Vec<Option<f64>>, Input> {
    let settings = 0..grid.settings() as usize;
    let models = settings.map(|setting| Model::new(&source.acquisition(setting)));
    let models = models.collect::<Result<Vec<_>, Input>>()?;
    // Light that is spread in time for another reason is not of one or two echoes and a window with a template.
    let plain: Vec<_> = source
        .scenarios()
        .map(|scenario| scenario.obstacles(Method::CramerRaoBound).next().is_none())
        .collect();
    let second_m: Vec<_> =
        source.scenarios().map(|scenario| scenario.target.second_distance_m).collect();
    let apart = grid.lights().div_ceil(MOST_LIGHTS).max(1);
    let bound = |&distance_m: &f64| {
        let mut white = Last(None);
        let variance = |light: u64| {
            let scene = Scene { distance_m, ..grid.scene_at(0, light) };
            let white = white.or(scene.setting, |_| source.white(&scene));
            let budget = scaled(white, &scene);
            let is_valid = budget.spread.is_none() || plain[scene.setting];
            if !budget.variation.is_none() || !is_valid {
                return None;
            }
            let standard_deviation =
                models[scene.setting].bound_of_scene_m(&budget, second_m[scene.setting])?;
            Some(standard_deviation * standard_deviation)
        };
        let lights = (0..grid.lights()).step_by(apart as usize);
        let variances: Option<Vec<f64>> = lights.map(variance).collect();
        let variances = variances?;
        let mean = variances.iter().sum::<f64>() / variances.len() as f64;
        Some(2e3 * mean.sqrt())
    };
    Ok(distances_m.par_iter().map(bound).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    #[test]
    fn the_bound_over_the_thesis_grid_is_what_a_prototype_found() {
        let ideal = ["tdc.profile=ideal".to_owned()];
        let setup = Setup::new(scenario::load("kc705", &ideal).unwrap()).unwrap();
        let source = HistogramSource::new(&setup).unwrap();
        let distances_m = [0.1, 0.3, 0.6];
        let bound = two_sd_mm(&source, &Grid::test(), &distances_m).unwrap();
        // Prototype: 0.5, 0.4 and 1.0 mm, to one decimal.
        for (found, expected) in bound.into_iter().zip([0.5, 0.4, 1.0]) {
            assert!((found.unwrap() - expected).abs() < 0.06, "{found:?}");
        }
    }
}
