//! An error budget for programs.

use serde_json::{Value, json};

use tofsim_learn::error_budget::state::EffectState;
use tofsim_learn::error_budget::{DepthBudget, EffectErrors};

use super::budgets::DepthBudgets;

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
