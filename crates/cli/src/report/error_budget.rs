//! An error budget: tables, JSON, CSV and a picture.

mod files;
mod picture;
mod text;

use serde_json::Value;

use tofsim::error::Result;

use super::sheet::NamedText;
use super::writer::Findings;

pub use files::DepthBudgets;

impl Findings for DepthBudgets<'_> {
    const SCHEMA: &'static str = "tofsim.errors/1";
    const FILE: Option<&'static str> = Some("errors.json");

    fn json(&self) -> Value {
        files::json(self)
    }

    fn text(&self) -> String {
        text::text(self)
    }

    fn sheets(&self) -> Vec<NamedText> {
        vec![("errors.csv".to_owned(), files::csv(self))]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(vec![("errors.svg".to_owned(), picture::svg(self)?)])
    }
}
