//! An error budget for programs: JSON, and a table for spreadsheets with a row for each value of the key and each effect.

use serde_json::{Value, json};

use tofsim_learn::error_budget::figures::{ErrorChange, ErrorFigures};
use tofsim_learn::error_budget::state::EffectState;
use tofsim_learn::error_budget::{DepthBudget, EffectErrors};
use tofsim_studies::table::Cell;

use crate::report::sheet::Digits::Shortest;
use crate::report::sheet::Sheet;

/// The budgets of a scenario at the values of one of its keys, or of the scenario alone.
pub struct DepthBudgets<'a> {
    /// The key, if there is one.
    pub key: Option<&'a str>,
    /// The value of the key, or else the distance, and the budget there.
    pub points: &'a [(f64, DepthBudget)],
}

/// Returns the points with the effects of each.
pub fn json(of: &DepthBudgets) -> Value {
    let first = of.points.first().map(|(_, budget)| budget);
    json!({
        "estimator": first.map(|budget| budget.kind.name()),
        "frames_per_variant": first.map(|budget| budget.frames),
        "key": of.key,
        "points": of.points.iter().map(|(value, budget)| point(*value, budget)).collect::<Vec<_>>(),
    })
}

fn point(value: f64, budget: &DepthBudget) -> Value {
    json!({
        "value": value,
        "distance_m": budget.distance_m,
        "every_effect_off": budget.none,
        "effects": budget.effects.iter().map(effect).collect::<Vec<_>>(),
        "all_together": budget.together,
        "sum_of_alone_mean_mm": budget.sum_mean_mm,
        "sum_of_alone_two_sd_mm": budget.sum_two_sd_mm,
        "cramer_rao_two_sd_mm": budget.bound.two_sd_mm,
        "cramer_rao_two_sd_fine_bins_mm": budget.bound.fine_two_sd_mm,
    })
}

fn effect(row: &EffectErrors) -> Value {
    let (state, reason) = words(&row.state);
    json!({
        "effect": row.effect.key(),
        "name": row.effect.name(),
        "state": state,
        "reason": reason,
        "alone": row.alone,
        "all_but": row.all_but,
        "alone_less_off": row.adds,
        "together_less_all_but": row.takes,
    })
}

/// A state as a word, and why.
pub fn words(state: &EffectState) -> (&'static str, Option<&str>) {
    match state {
        EffectState::On => ("on", None),
        EffectState::Off(why) => ("off", Some(why)),
        EffectState::LeftOut(why) => ("left_out", Some(why)),
    }
}

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
