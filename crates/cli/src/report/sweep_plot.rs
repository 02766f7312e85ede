//! A sweep's picture, as its plan has it.

mod axes;
pub mod lines;
mod surface;

use tofsim_studies::plan::file::{Plot, PlotKind};
use tofsim_studies::table::{Field, Row};

/// The picture.
///
/// # Errors
/// When no row has what it shows, or the plotting library fails.
pub fn svg(plot: &Plot, fields: &[Field], rows: &[Row]) -> Result<String, String> {
    match plot.kind {
        PlotKind::Lines => lines::svg(plot, fields, rows),
        PlotKind::Surface => surface::svg(plot, fields, rows),
    }
}
