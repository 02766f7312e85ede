//! The figures of an evaluation as files: CSV, box plots, and the spread by distance over the Cramer-Rao bound.

use plotters::style::{BLACK, RED};

use tofsim::error::Result;
use tofsim_learn::dataset::Grid;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::evaluation::{Figures, Group, Spread, thesis};

use super::box_plot::{BoxPlot, Limit, Series};
use super::curves::{Curve, curves};
use super::sheet::Digits::Shortest;
use super::sheet::{NamedText, Sheet};

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

/// Returns a row for each estimator and pixel of an array.
pub fn pixels(figures: &[Figures]) -> String {
    let of_each = figures.iter().map(|one| one.by_pixel.iter().map(move |of| (one.name, of)));
    let rows: Vec<_> = of_each.flatten().collect();
    let sheet = Sheet::of(&rows)
        .column("estimator", Shortest, |(name, _)| *name)
        .column("pixel_row", Shortest, |(_, of)| of.row as u64)
        .column("pixel_column", Shortest, |(_, of)| of.column as u64);
    with_figures(sheet, |(_, of)| &of.spread).csv()
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
    let places = figures.first().map_or(&[][..], |one| &one.by_pixel);
    if !places.is_empty() {
        sheet = sheet
            .column("pixel_row", Shortest, move |(_, of)| places[of.scene.pixel].row as u64)
            .column("pixel_column", Shortest, move |(_, of)| places[of.scene.pixel].column as u64);
    }
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

/// Values of a picture of several estimators.
const SHOWN: usize = 11;

/// Errors that the specification allows.
const ALLOWED: Limit =
    Limit { name: "specification (Table 5.2)", mm: thesis::allowed_error_mm, colour: BLACK };

/// The spread that the thesis's network has.
const LINE: Limit = Limit {
    name: "2σ for the thesis's float network (Table 5.5)",
    mm: thesis::line_two_sd_mm,
    colour: RED,
};

/// Draws a picture for each estimator and quantity, and one for each quantity with all estimators side by side if
/// there are several; with the line of the thesis's network where scenes are the thesis's.
///
/// # Errors
/// When the plotting library fails.
pub fn plots(figures: &[Figures], thesis: bool) -> Result<Vec<NamedText>> {
    let of_each: Vec<_> = figures.iter().map(Figures::groupings).collect();
    let first = of_each.first().map_or(&[][..], Vec::as_slice);
    let mut plots = Vec::new();
    for (k, of) in first.iter().enumerate() {
        let limits: &[Limit] = match (of.key == "distance_m", thesis) {
            (false, _) => &[],
            (true, false) => &[ALLOWED],
            (true, true) => &[ALLOWED, LINE],
        };
        let series = figures.iter().zip(&of_each);
        let series = series.map(|(one, all)| Series { name: one.name, groups: all[k].groups });
        let series: Vec<_> = series.filter(|one| !one.groups.is_empty()).collect();
        plots.extend(of_quantity(of.key, of.quantity, &series, limits)?);
    }
    Ok(plots)
}

/// Draws twice the standard deviation of each estimator by distance, with the bound below [m, mm]; nothing of a
/// single distance.
///
/// # Errors
/// When the plotting library fails.
pub fn spread(figures: &[Figures], bound: &[(f64, f64)]) -> Result<Option<NamedText>> {
    let points = |one: &Figures| -> Vec<(f64, f64)> {
        let groups = one.by_distance_m.iter();
        groups.filter_map(|group| Some((group.value, group.spread.two_sd_mm?))).collect()
    };
    let each: Vec<_> = figures.iter().map(|one| (one.name, points(one))).collect();
    let mut all: Vec<_> = each.iter().map(|(name, points)| Curve::new(name, points)).collect();
    all.extend((!bound.is_empty()).then(|| Curve::bound(bound)));
    let is_line = each.iter().any(|(_, points)| points.len() > 1);
    if !is_line {
        return Ok(None);
    }
    let svg = curves("twice the standard deviation of the depth", "2σ [mm]", true, &all)?;
    Ok(Some(("spread_by_distance_m.svg".to_owned(), svg)))
}

fn of_quantity(
    key: &str,
    quantity: &str,
    series: &[Series],
    limits: &[Limit],
) -> Result<Vec<NamedText>> {
    let one = |series: &Series| {
        let title = format!("{}: errors by {quantity}", series.name);
        let plot = BoxPlot { title: &title, quantity, series: &[*series], limits };
        Ok((format!("{}_by_{key}.svg", series.name), plot.svg()?))
    };
    let mut plots = series.iter().map(one).collect::<Result<Vec<_>>>()?;
    if let [first, _, ..] = series {
        let values: Vec<_> = first.groups.iter().map(|group| group.value).collect();
        let values = thinned(&values, SHOWN);
        let shown = |one: &Series| -> Vec<Group> {
            let groups = one.groups.iter().filter(|group| values.contains(&group.value));
            groups.cloned().collect()
        };
        let groups: Vec<_> = series.iter().map(shown).collect();
        let series = series.iter().zip(&groups);
        let series: Vec<_> = series.map(|(one, groups)| Series { groups, ..*one }).collect();
        let title = format!("errors by {quantity}");
        let plot = BoxPlot { title: &title, quantity, series: &series, limits };
        plots.push((format!("errors_by_{key}.svg"), plot.svg()?));
    }
    Ok(plots)
}
