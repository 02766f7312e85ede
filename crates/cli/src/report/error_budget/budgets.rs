//! Depth error budgets over the values of a key.

use tofsim_learn::error_budget::DepthBudget;

/// The budgets of a scenario at the values of one of its keys, or of the scenario alone.
pub struct DepthBudgets<'a> {
    /// The key, if there is one.
    pub key: Option<&'a str>,
    /// The value of the key, or else the distance, and the budget there.
    pub points: &'a [(f64, DepthBudget)],
}
