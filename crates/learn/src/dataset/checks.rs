//! What no row of a dataset has.

use tofsim::network::{Histogram, MAX_HITS};

use super::parquet_file::HEAD;
use super::scene::Scene;

/// What is wrong with a row: the column, what stands there and what was expected.
pub(super) type Fault = (String, String, String);

/// Refuses what no scene has.
pub(super) fn check_truth(scene: &Scene) -> std::result::Result<(), Fault> {
    let values = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
    for (name, value) in HEAD[2..].iter().zip(values) {
        if !(0.0..=f64::MAX).contains(&value) {
            let column = format!("column {name}");
            return Err((column, value.to_string(), "expected a number from 0".to_owned()));
        }
    }
    Ok(())
}

/// Refuses what the estimator's words do not bear.
pub(super) fn check_total(histogram: &Histogram) -> std::result::Result<(), Fault> {
    let total: u32 = histogram.iter().map(|&count| u32::from(count)).sum();
    if total > MAX_HITS {
        let expected = format!("the estimator's bit widths allow {MAX_HITS} hits in all");
        return Err(("total".to_owned(), total.to_string(), expected));
    }
    Ok(())
}
