//! A frame with its waveform, and set-ups for the viewers beside it.

use std::path::Path;

use serde_json::Value;

use tofsim::error::{Input, Result, read_text};
use tofsim::files::folder;

use super::site::Site;
use super::step::Outcome;

/// Its folder.
pub const FOLDER: &str = "frame";

pub fn run(site: &Site) -> Result<Outcome> {
    site.run(&["run", site.scenario(), "-o", FOLDER])?;
    let path = Path::new(FOLDER).join("summary.json");
    let result: Value = serde_json::from_str(&read_text(&path)?)
        .map_err(|error| Input::new(path.display(), error))?;
    let frame = &result["frames"][0];
    let depth = |key: &str| frame[key].as_f64().map_or("-".to_owned(), |m| format!("{m:.6} m"));
    let summary = format!("depth {} of {}", depth("depth_m"), depth("true_depth_m"));
    let outputs = folder::files_below(FOLDER.as_ref())?;
    Ok(Outcome { outputs, result, passed: true, summary })
}
