//! The reports' pictures, for notebooks.

use tofsim::Setup;
use tofsim::error::Input;
use tofsim_cli::report::causes;
use tofsim_cli::report::causes::{CAUSES, Causes};
use tofsim_cli::report::page::facts;

use crate::errors::Result;

/// Formats a scenario as tables.
pub fn scenario(setup: &Setup) -> String {
    let heading = format!("<h3>{}</h3>\n", setup.name);
    heading + &facts::section(setup, &serde_json::Value::Null)
}

/// A histogram over time and depth, by cause where that is known.
///
/// # Errors
/// When the plotting library fails.
pub fn histogram(
    setup: &Setup,
    title: &str,
    (counts, causes): (&[u32], Option<&Causes>),
    depth_m: Option<f64>,
) -> Result<String> {
    let bins = setup.scenario.tdc.bins as usize;
    let unknown = || {
        let mut causes = Causes::default();
        causes.iter_mut().for_each(|counts| counts.resize(bins, 0));
        // The last one is that of hits whose cause is not known.
        causes[CAUSES.len() - 1].copy_from_slice(counts);
        causes
    };
    let causes = causes.cloned().unwrap_or_else(unknown);
    let svg = causes::svg(title, &causes, &setup.scenario.tdc, setup.true_depth_m(), depth_m);
    Ok(svg.map_err(|why| Input::new("picture", why))?)
}
