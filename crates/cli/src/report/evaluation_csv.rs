//! The figures of an evaluation as CSV.

use tofsim_learn::dataset::Grid;
use tofsim_learn::evaluation::{Figures, SceneErrors, Spread};

/// What is said of errors.
const FIGURES: &str = "estimates,failures,outliers,mean_mm,mean_se_mm,two_sd_mm,two_sd_se_mm,\
    least_mm,lower_quartile_mm,median_mm,upper_quartile_mm,largest_mm";

/// A row for each estimator and value of a quantity.
pub fn groups(figures: &[Figures]) -> String {
    let mut text = format!("estimator,by,value,{FIGURES}\n");
    for one in figures {
        for grouping in one.groupings() {
            for group in grouping.groups {
                let (key, numbers) = (grouping.key, numbers(&group.spread));
                text += &format!("{},{key},{},{numbers}\n", one.name, group.value);
            }
        }
    }
    text
}

/// A row for each estimator and scene.
pub fn scenes(figures: &[Figures], grid: Option<&Grid>) -> String {
    let keys = |setting| grid.map_or(Vec::new(), |grid| grid.setting(setting));
    let names: String = keys(0).iter().map(|(key, _)| format!("{key},")).collect();
    let mut text =
        format!("estimator,distance_m,reflectance,irradiance_w_m2_nm,{names}{FIGURES}\n");
    for one in figures {
        for SceneErrors { scene, spread } in &one.by_scene {
            let light = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
            let values = light.into_iter().chain(keys(scene.setting).into_iter().map(|key| key.1));
            let values: String = values.map(|value| format!("{value},")).collect();
            text += &format!("{},{values}{}\n", one.name, numbers(spread));
        }
    }
    text
}

fn numbers(spread: &Spread) -> String {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let counts =
        [spread.estimates, spread.failures, spread.outliers].map(|count| count.to_string());
    let moments = [spread.mean_mm, spread.mean_se_mm, spread.two_sd_mm, spread.two_sd_se_mm];
    let quartiles = [0, 1, 2, 3, 4].map(|k| number(spread.quartiles_mm.map(|five| five[k])));
    [&counts[..], &moments.map(number), &quartiles].concat().join(",")
}
