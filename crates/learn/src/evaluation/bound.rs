//! The Cramer-Rao bound over a grid: no unbiased estimator that does not know the light is better.

use rayon::prelude::*;

use tofsim::error::Input;

use crate::dataset::source::scaled;
use crate::dataset::{Grid, HistogramSource};
use crate::estimation::Acquisition;
use crate::estimation::likelihood::Model;

/// Twice the root mean square of the bound over the grid's lights at each distance; `None` where a
/// scene tells nothing, as without a laser [mm].
///
/// # Errors
/// When the acquisition makes no sense.
pub fn two_sd_mm(
    source: &HistogramSource,
    acquisition: &Acquisition,
    grid: &Grid,
    distances_m: &[f64],
) -> Result<Vec<Option<f64>>, Input> {
    let model = Model::new(acquisition)?;
    let bound = |&distance_m: &f64| {
        let white = source.white(distance_m);
        let variance = |light: u64| {
            let scene = crate::dataset::Scene { distance_m, ..grid.scene_at(0, light) };
            let budget = scaled(&white, &scene);
            let standard_deviation = model.cramer_rao_m(&(&budget).into())?;
            Some(standard_deviation * standard_deviation)
        };
        let variances: Option<Vec<f64>> = (0..grid.lights()).map(variance).collect();
        let mean = variances?.iter().sum::<f64>() / grid.lights() as f64;
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
        let acquisition = Acquisition::new(source.bins(), 30_000, 137.0);
        let distances_m = [0.1, 0.3, 0.6];
        let bound = two_sd_mm(&source, &acquisition, &Grid::test(), &distances_m).unwrap();
        // Prototype: 0.5, 0.4 and 1.0 mm, to one decimal.
        for (found, expected) in bound.into_iter().zip([0.5, 0.4, 1.0]) {
            assert!((found.unwrap() - expected).abs() < 0.06, "{found:?}");
        }
    }
}
