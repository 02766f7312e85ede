//! Tables of the estimators' results.

use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::Estimate;

use crate::text::table::{number_or_dash, signed, signed_or_dash, table};

use super::frame_log::FrameLog;
use super::statistics::EstimatorStatistics;

/// Returns a row for each estimator's result of the only frame or pair, with its error.
pub fn rows(setup: &Setup, readings: &[Estimate]) -> impl Iterator<Item = (&'static str, String)> {
    readings.iter().map(|reading| {
        let error = |depth_m: f64, truth| format!("  {} mm", signed(1e3 * (depth_m - truth), 2));
        let depth = |depth_m| {
            let error = setup.true_depth_m().map_or(String::new(), |truth| error(depth_m, truth));
            format!("{depth_m:.6} m{error}")
        };
        let unit = if reading.second.is_some() { " m" } else { "" };
        (reading.estimator, said(reading, depth) + unit)
    })
}

/// A row for each frame or pair that the log has rows of, `left` more being left out: `cells`, and what
/// the estimators say; and rows below them.
pub fn many<'a>(
    header: &[&str],
    log: &FrameLog,
    rows: impl Iterator<Item = (Vec<String>, &'a Vec<Estimate>)>,
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

/// Of each estimator over all frames or pairs: mean, 2σ, mean error [mm], outliers, failures.
fn statistics(log: &FrameLog) -> Vec<[String; 5]> {
    let metres = |m: Option<f64>| number_or_dash(m, 6);
    let cells = |one: EstimatorStatistics| {
        let error = signed_or_dash(one.mean_error_m.map(|m| 1e3 * m), 3);
        let counts = [one.outliers, one.failures].map(|count| count.to_string());
        let [outliers, failures] = counts;
        [metres(one.mean_m), metres(one.two_sd_m), error, outliers, failures]
    };
    log.estimators().into_iter().map(cells).collect()
}

/// Rows of the same below frames or pairs, of so many cells before the estimators': a name, and in `own` the values of
/// the firmware's own estimator.
pub fn below(log: &FrameLog, cells: usize, own: Option<[String; 5]>) -> Vec<Vec<String>> {
    let others = statistics(log);
    let names = ["mean", "2σ", "error [mm]", "outliers", "failures"];
    // The firmware always has a depth.
    let shown = match (others.is_empty(), &own) {
        (false, _) => names.len(),
        (true, Some(_)) => names.len() - 1,
        (true, None) => 0,
    };
    let row = |(k, name): (usize, &str)| {
        let mut row = vec![name.to_owned()];
        row.extend(own.iter().map(|five| five[k].clone()));
        row.resize(cells, String::new());
        row.extend(others.iter().map(|five| five[k].clone()));
        row
    };
    names.into_iter().enumerate().take(shown).map(row).collect()
}

/// A depth, and that of a second echo, or why there is none.
pub fn said(reading: &Estimate, depth: impl Fn(f64) -> String) -> String {
    let Some(depth_m) = reading.depth_m else { return reading.failure.clone().unwrap_or_default() };
    let second = reading.second.map(|second| format!(" and {:.6}", second.depth_m));
    depth(depth_m) + &second.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use tofsim_learn::estimation::EchoDepth;

    use super::*;

    #[test]
    fn a_second_surface_stands_beside_the_first_and_its_error() {
        let setup = Setup::load("kc705", &[]).unwrap();
        let second = Some(EchoDepth::new(0.75, 0.001));
        let reading = Estimate { second, ..Estimate::of_depth("two-echoes", Some(0.501)) };
        let found: Vec<_> = rows(&setup, &[reading]).collect();
        let said = "0.501000 m  +1.00 mm and 0.750000 m".to_owned();
        assert_eq!(found, [("two-echoes", said)]);
    }
}
