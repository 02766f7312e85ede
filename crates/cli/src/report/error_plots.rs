//! The pictures of an evaluation: box plots, and the spread by distance over the Cramer-Rao bound.

use plotters::style::{BLACK, RED};

use tofsim::error::Result;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::evaluation::{Figures, Group, thesis};

use super::box_plot::{BoxPlot, Limit, Series};
use super::curves::{Curve, curves};
use super::sheet::NamedText;

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
pub fn all(figures: &[Figures], thesis: bool) -> Result<Vec<NamedText>> {
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
