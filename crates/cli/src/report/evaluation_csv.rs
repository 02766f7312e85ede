//! The figures of an evaluation as CSV.

use tofsim_learn::dataset::Grid;
use tofsim_learn::evaluation::{Figures, Spread};

use super::sheet::Digits::Shortest;
use super::sheet::Sheet;

/// Returns a row for each estimator and value of a quantity.
pub fn groups(figures: &[Figures]) -> String {
    let mut rows = Vec::new();
    for one in figures {
        for by in one.groupings() {
            rows.extend(by.groups.iter().map(|group| (one.name, by.key, group)));
        }
    }
    let sheet = Sheet::of(&rows)
        .column("estimator", Shortest, |(name, ..)| *name)
        .column("by", Shortest, |(_, key, _)| *key)
        .column("value", Shortest, |(.., group)| group.value);
    with_figures(sheet, |(.., group)| &group.spread).csv()
}

/// Returns a row for each estimator and scene.
pub fn scenes(figures: &[Figures], grid: Option<&Grid>) -> String {
    let mut rows = Vec::new();
    for one in figures {
        rows.extend(one.by_scene.iter().map(|of| (one.name, of)));
    }
    let mut sheet = Sheet::of(&rows)
        .column("estimator", Shortest, |(name, _)| *name)
        .column("distance_m", Shortest, |(_, of)| of.scene.distance_m)
        .column("reflectance", Shortest, |(_, of)| of.scene.reflectance)
        .column("irradiance_w_m2_nm", Shortest, |(_, of)| of.scene.irradiance_w_m2_nm);
    let setting = |setting| grid.map_or(Vec::new(), |grid| grid.setting(setting));
    for (k, (key, _)) in setting(0).into_iter().enumerate() {
        sheet = sheet.column(key, Shortest, |(_, of)| setting(of.scene.setting)[k].1);
    }
    with_figures(sheet, |(_, of)| &of.spread).csv()
}

/// Adds the figures of errors.
fn with_figures<'a, R>(sheet: Sheet<'a, R>, of: fn(&R) -> &Spread) -> Sheet<'a, R> {
    let quartile = |k: usize| move |row: &'a R| of(row).quartiles_mm.map(|five| five[k]);
    sheet
        .column("estimates", Shortest, |row| of(row).estimates)
        .column("failures", Shortest, |row| of(row).failures)
        .column("outliers", Shortest, |row| of(row).outliers)
        .column("mean_mm", Shortest, |row| of(row).mean_mm)
        .column("mean_se_mm", Shortest, |row| of(row).mean_se_mm)
        .column("two_sd_mm", Shortest, |row| of(row).two_sd_mm)
        .column("two_sd_se_mm", Shortest, |row| of(row).two_sd_se_mm)
        .column("least_mm", Shortest, quartile(0))
        .column("lower_quartile_mm", Shortest, quartile(1))
        .column("median_mm", Shortest, quartile(2))
        .column("upper_quartile_mm", Shortest, quartile(3))
        .column("largest_mm", Shortest, quartile(4))
}
