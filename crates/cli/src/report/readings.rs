//! What estimators say of frames, in tables.

use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::Reading;

use crate::text::table::table;

use super::frame_log::FrameLog;

/// What each estimator says of the only frame or pair, with its error.
pub fn rows(setup: &Setup, readings: &[Reading]) -> impl Iterator<Item = (&'static str, String)> {
    readings.iter().map(|reading| {
        let error = |depth_m: f64, truth| format!("  {:+.2} mm", 1e3 * (depth_m - truth));
        let depth = |depth_m| {
            let error = setup.true_depth_m().map_or(String::new(), |truth| error(depth_m, truth));
            format!("{depth_m:.6} m{error}")
        };
        (reading.estimator, said(reading, depth))
    })
}

/// A row for each frame or pair that the log has rows of, `left` more being left out: `cells`, and what
/// the estimators say; and rows below them.
pub fn many<'a>(
    header: &[&str],
    log: &FrameLog,
    rows: impl Iterator<Item = (Vec<String>, &'a Vec<Reading>)>,
    left: u64,
    below: Vec<Vec<String>>,
) -> String {
    let asked = log.readings.iter().rfind(|readings| !readings.is_empty());
    let names = asked.into_iter().flatten().map(|reading| reading.estimator);
    let rows = rows.map(|(mut cells, readings)| {
        let depth = |reading| said(reading, |depth_m| format!("{depth_m:.6}"));
        cells.extend(readings.iter().map(depth));
        cells
    });
    let left = (left > 0).then(|| vec![format!("... {left} more")]);
    let header: Vec<_> = header.iter().copied().chain(names).collect();
    table(header, rows.chain(left).chain(below), ..)
}

/// A depth, or why there is none.
fn said(reading: &Reading, depth: impl Fn(f64) -> String) -> String {
    reading.depth_m.map_or_else(|| reading.failure.clone().unwrap_or_default(), depth)
}
