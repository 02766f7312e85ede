//! An error budget as a table for spreadsheets: a row for each value of the key and each effect.

use std::fmt::Write;

use tofsim_learn::error_budget::DepthBudget;
use tofsim_learn::error_budget::figures::{ErrorChange, ErrorFigures};

use super::DepthBudgets;
use super::json::words;

/// Figures of a column group.
const FIGURES: [&str; 6] =
    ["mean_mm", "mean_se_mm", "two_sd_mm", "two_sd_se_mm", "failures", "outliers"];
/// Changes of a column group.
const CHANGES: [&str; 4] = ["mean_mm", "mean_se_mm", "variance_mm2", "variance_se_mm2"];

/// The table. Of what has no number the field is empty; `every_effect_off` and `all_together` stand in the columns
/// of what is alone.
pub fn csv(of: &DepthBudgets) -> String {
    let groups = [("alone", &FIGURES[..]), ("all_but", &FIGURES), ("alone_less_off", &CHANGES)];
    let groups = groups.into_iter().chain([("together_less_all_but", &CHANGES[..])]);
    let names =
        groups.flat_map(|(group, names)| names.iter().map(move |name| format!("{group}_{name}")));
    let mut text = format!(
        "{},effect,state,{}\n",
        of.key.unwrap_or("target.distance_m"),
        names.collect::<Vec<_>>().join(",")
    );
    for (value, budget) in of.points {
        for (effect, state, cells) in rows(budget) {
            // Writing to a string never fails.
            let _ = writeln!(text, "{value},{effect},{state},{}", cells.join(","));
        }
    }
    text
}

fn rows(budget: &DepthBudget) -> Vec<(&'static str, &'static str, Vec<String>)> {
    let whole = |name, of: &ErrorFigures| (name, "", cells(Some(of), None, None, None));
    let effects = budget.effects.iter().map(|row| {
        let groups = (row.alone.as_ref(), row.all_but.as_ref());
        let cells = cells(groups.0, groups.1, row.adds.as_ref(), row.takes.as_ref());
        (row.effect.key(), words(&row.state).0, cells)
    });
    let first = whole("every_effect_off", &budget.none);
    [first].into_iter().chain(effects).chain([whole("all_together", &budget.together)]).collect()
}

fn cells(
    alone: Option<&ErrorFigures>,
    all_but: Option<&ErrorFigures>,
    adds: Option<&ErrorChange>,
    takes: Option<&ErrorChange>,
) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let figures = |of: Option<&ErrorFigures>| {
        let spread = |of: &ErrorFigures| {
            [of.mean_mm, of.mean_se_mm, of.two_sd_mm, of.two_sd_se_mm].map(number)
        };
        let counts = |of: &ErrorFigures| [of.failures, of.outliers].map(|count| count.to_string());
        of.map_or(vec![String::new(); FIGURES.len()], |of| [&spread(of)[..], &counts(of)].concat())
    };
    let changes = |of: Option<&ErrorChange>| {
        let all =
            |of: &ErrorChange| [of.mean_mm, of.mean_se_mm, of.variance_mm2, of.variance_se_mm2];
        of.map_or(vec![String::new(); CHANGES.len()], |of| all(of).map(number).to_vec())
    };
    [figures(alone), figures(all_but), changes(adds), changes(takes)].concat()
}
