//! An error budget: tables, JSON, CSV and a picture.

mod csv;
mod json;
mod picture;
mod text;

use serde_json::Value;

use tofsim::error::Result;
use tofsim_learn::error_budget::DepthBudget;

use super::sheet::NamedText;
use super::writer::Findings;

/// The budgets of a scenario at the values of one of its keys, or of the scenario alone.
pub struct DepthBudgets<'a> {
    /// The key, if there is one.
    pub key: Option<&'a str>,
    /// The value of the key, or else the distance, and the budget there.
    pub points: &'a [(f64, DepthBudget)],
}

impl Findings for DepthBudgets<'_> {
    const SCHEMA: &'static str = "tofsim.errors/1";
    const FILE: Option<&'static str> = Some("errors.json");

    fn json(&self) -> Value {
        json::json(self)
    }

    fn text(&self) -> String {
        text::text(self)
    }

    fn sheets(&self) -> Vec<NamedText> {
        vec![("errors.csv".to_owned(), csv::csv(self))]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(vec![("errors.svg".to_owned(), picture::svg(self)?)])
    }
}
