//! An error budget as a table for spreadsheets: a row for each value of the key and each effect.

use tofsim_learn::error_budget::DepthBudget;
use tofsim_learn::error_budget::figures::{ErrorChange, ErrorFigures};
use tofsim_studies::table::Cell;

use crate::report::sheet::Digits::Shortest;
use crate::report::sheet::Sheet;

use super::budgets::DepthBudgets;
use super::json::words;

/// Names and values of a group of columns.
type Columns<T> = [(&'static str, fn(&T) -> Cell)];

const FIGURES: &Columns<ErrorFigures> = &[
    ("mean_mm", |of| of.mean_mm.into()),
    ("mean_se_mm", |of| of.mean_se_mm.into()),
    ("two_sd_mm", |of| of.two_sd_mm.into()),
    ("two_sd_se_mm", |of| of.two_sd_se_mm.into()),
    ("failures", |of| of.failures.into()),
    ("outliers", |of| of.outliers.into()),
];
const CHANGES: &Columns<ErrorChange> = &[
    ("mean_mm", |of| of.mean_mm.into()),
    ("mean_se_mm", |of| of.mean_se_mm.into()),
    ("variance_mm2", |of| of.variance_mm2.into()),
    ("variance_se_mm2", |of| of.variance_se_mm2.into()),
];

/// The figures of an effect at a value of the key.
#[derive(Default)]
struct EffectRow<'a> {
    value: f64,
    effect: &'static str,
    state: &'static str,
    alone: Option<&'a ErrorFigures>,
    all_but: Option<&'a ErrorFigures>,
    adds: Option<&'a ErrorChange>,
    takes: Option<&'a ErrorChange>,
}

/// Returns the table. `every_effect_off` and `all_together` have figures in the columns of what is alone.
pub fn csv(of: &DepthBudgets) -> String {
    let rows: Vec<_> = of.points.iter().flat_map(|(value, budget)| rows(*value, budget)).collect();
    let sheet = Sheet::of(&rows)
        .column(of.key.unwrap_or("target.distance_m"), Shortest, |row| row.value)
        .column("effect", Shortest, |row| row.effect)
        .column("state", Shortest, |row| row.state);
    let sheet = group(sheet, "alone", FIGURES, |row| row.alone);
    let sheet = group(sheet, "all_but", FIGURES, |row| row.all_but);
    let sheet = group(sheet, "alone_less_off", CHANGES, |row| row.adds);
    group(sheet, "together_less_all_but", CHANGES, |row| row.takes).csv()
}

/// Adds a group of columns, empty where a row has none of them.
fn group<'a, T>(
    sheet: Sheet<'a, EffectRow<'a>>,
    name: &str,
    columns: &Columns<T>,
    of: fn(&EffectRow<'a>) -> Option<&'a T>,
) -> Sheet<'a, EffectRow<'a>> {
    columns.iter().fold(sheet, |sheet, (column, value)| {
        sheet.column(format!("{name}_{column}"), Shortest, move |row| of(row).map(value))
    })
}

fn rows(value: f64, budget: &DepthBudget) -> Vec<EffectRow<'_>> {
    let whole = |effect, of| EffectRow { value, effect, alone: Some(of), ..EffectRow::default() };
    let effects = budget.effects.iter().map(|row| EffectRow {
        value,
        effect: row.effect.key(),
        state: words(&row.state).0,
        alone: row.alone.as_ref(),
        all_but: row.all_but.as_ref(),
        adds: row.adds.as_ref(),
        takes: row.takes.as_ref(),
    });
    let first = whole("every_effect_off", &budget.none);
    [first].into_iter().chain(effects).chain([whole("all_together", &budget.together)]).collect()
}
