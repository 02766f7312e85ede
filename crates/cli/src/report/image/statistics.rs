//! Statistics of an image.

use serde::Serialize;

use tofsim_learn::evaluation::Spread;
use tofsim_learn::evaluation::images::ImageDepths;

use crate::report::sheet::Digits::{Fixed, Shortest};
use crate::report::sheet::Sheet;
use crate::text::table::number_or_dash;

/// Most rows of a table that is printed.
pub const SHOWN: usize = 20;

/// Statistics of the pixels of an image.
#[derive(Serialize)]
pub struct ImageStatistics {
    /// Pixels with a valid depth.
    valid: u64,
    /// Part of the pixels with a valid depth [1].
    fill_rate: f64,
    /// Median standard deviation that is stated of a valid depth [m].
    median_sigma_m: Option<f64>,
    /// Root mean square of the errors of valid depths [mm].
    rms_error_mm: Option<f64>,
    /// Errors of the valid depths, along the line of sight.
    errors: Spread,
}

impl ImageStatistics {
    /// Returns the statistics of an image.
    pub fn of(depths: &ImageDepths, image: usize) -> Self {
        ImageStatistics {
            valid: depths.valid(image).count() as u64,
            fill_rate: depths.fill_rate(image),
            median_sigma_m: depths.median_sigma_m(image),
            rms_error_mm: depths.mean_square_mm2(image).map(f64::sqrt),
            errors: Spread::of(depths.errors_m(image).map(Some)),
        }
    }
}

/// Returns the table of images.
pub fn table(images: &[ImageStatistics]) -> String {
    let shown: Vec<_> = images.iter().enumerate().take(SHOWN).collect();
    let quartile = |of: &ImageStatistics, k: usize| of.errors.quartiles_mm.map(|all| all[k]);
    Sheet::of(&shown)
        .both(("image", Shortest), ("image", Shortest), |(image, _)| *image as u64)
        .words("valid", |(_, of)| format!("{} ({:.1} %)", of.valid, 100.0 * of.fill_rate))
        .words("mean error [mm]", |(_, of)| number_or_dash(of.errors.mean_mm, 3))
        .words("rms error [mm]", |(_, of)| number_or_dash(of.rms_error_mm, 3))
        .words("median error [mm]", move |(_, of)| number_or_dash(quartile(of, 2), 3))
        .both(("median_sigma_mm", Fixed(3)), ("median sigma [mm]", Fixed(3)), |(_, of)| {
            of.median_sigma_m.map(|sigma_m| 1e3 * sigma_m)
        })
        .table()
}
