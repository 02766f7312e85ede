//! An error budget: tables, JSON, CSV and a picture.

mod budgets;
mod csv;
mod json;
mod picture;
mod text;

use serde_json::Value;

use tofsim::error::Result;

use super::sheet::NamedText;
use super::writer::Findings;

pub use budgets::DepthBudgets;

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
