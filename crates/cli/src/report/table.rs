//! The short table that a run prints.

use std::time::Duration;

use comfy_table::{CellAlignment, Table};

use tofsim::sim::frames::Frame;
use tofsim::sim::setup::{CYCLE, Setup};
use tofsim_learn::estimation::Reading;

use crate::text::table::{grouped, plain};

use super::frame_log::FrameLog;
use super::pair_table;
use super::summary::{Spread, TdcSummary};

/// What came of a run, in a dozen lines.
pub fn run(setup: &Setup, log: &FrameLog, cycles: u64, wall: Duration) -> String {
    let mut text = format!("{}: {}\n\n", setup.name, setup.scenario.description);
    match log.rows.as_slice() {
        _ if log.pairs.is_some() => text += &pair_table::table(setup, log).trim_fmt(),
        [frame] => text += &one_frame(setup, frame, &log.readings[0]).trim_fmt(),
        _ => text += &many_frames(log).trim_fmt(),
    }
    if let (Some(pairs), 3..) = (&log.pairs, log.count) {
        text += &format!("\n\n{}", pair_table::lines(&pairs.tally()).trim_end());
    }
    let rate = cycles as f64 / wall.as_secs_f64();
    text += &format!(
        "\n\n{} cycles in {:.1} ms: {:.1} million cycles per second\n",
        grouped(cycles),
        wall.as_secs_f64() * 1e3,
        rate / 1e6,
    );
    text
}

fn one_frame(setup: &Setup, frame: &Frame, readings: &[Reading]) -> Table {
    let mut table = plain();
    let mut row = |name: &str, value: String| {
        table.add_row([name.to_owned(), value]);
    };
    if let Some(truth) = setup.true_depth_m() {
        row("true depth", format!("{truth:.6} m"));
        let error_mm = (frame.depth_m() - truth) * 1e3;
        let raw = frame.depth.bits();
        row("estimated", format!("{:.6} m  {raw:09x}  {error_mm:+.2} mm", frame.depth_m()));
    } else {
        row("estimated", format!("{:.6} m  {:09x}", frame.depth_m(), frame.depth.bits()));
    }
    self::readings(setup, readings, &mut row);
    row("shots", grouped(frame.shots));
    row("TDC hits", grouped(frame.tdc_hits));
    row("codes counted", grouped(frame.hits()));
    row("estimator", format!("{} cycles", frame.estimator_cycles));
    let board_ms = frame.frame_cycles as f64 * CYCLE.seconds() * 1e3;
    row("frame", format!("{} cycles, {board_ms:.6} ms on the board", grouped(frame.frame_cycles)));
    table
}

/// A row for what each estimator says.
pub(super) fn readings(setup: &Setup, readings: &[Reading], row: &mut impl FnMut(&str, String)) {
    for reading in readings {
        let error_mm = |depth_m| Some(1e3 * (depth_m - setup.true_depth_m()?));
        let error =
            |depth_m| error_mm(depth_m).map_or(String::new(), |mm| format!("  {mm:+.2} mm"));
        let depth = |depth_m| format!("{depth_m:.6} m{}", error(depth_m));
        let failure = || reading.failure.clone().unwrap_or_default();
        row(reading.estimator, reading.depth_m.map_or_else(failure, depth));
    }
}

/// What an estimator says, in a cell.
pub(super) fn depth_or_failure(reading: &Reading) -> String {
    let failure = || reading.failure.clone().unwrap_or_default();
    reading.depth_m.map_or_else(failure, |depth_m| format!("{depth_m:.6}"))
}

fn many_frames(log: &FrameLog) -> Table {
    let mut table = plain();
    let mut header = vec!["frame", "depth [m]", "word", "TDC hits", "codes", "estimator", "cycles"];
    header.extend(log.readings.iter().take(1).flatten().map(|reading| reading.estimator));
    table.set_header(header);
    for (frame, readings) in log.rows.iter().zip(&log.readings) {
        let mut cells = vec![
            frame.index.to_string(),
            format!("{:.6}", frame.depth_m()),
            format!("{:09x}", frame.depth.bits()),
            grouped(frame.tdc_hits),
            grouped(frame.hits()),
            frame.estimator_cycles.to_string(),
            grouped(frame.frame_cycles),
        ];
        cells.extend(readings.iter().map(depth_or_failure));
        table.add_row(cells);
    }
    if log.count > log.rows.len() as u64 {
        table.add_row([format!("... {} more", log.count - log.rows.len() as u64)]);
    }
    if let Some(Spread { mean_m, two_sd_m }) = log.spread() {
        table.add_row(["mean".to_owned(), format!("{mean_m:.6}")]);
        table.add_row(["2 sd".to_owned(), format!("{two_sd_m:.6}")]);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Thesis Table 6.3.
pub fn tdc(results: &[TdcSummary]) -> String {
    let mut table = plain();
    table.set_header(["T2 [ps]", "N", "T1 [ns]", "code"]);
    for result in results {
        let number = |value: Option<u64>| value.map_or("-".to_owned(), |value| value.to_string());
        table.add_row([
            result.t2_ps.map_or("-".to_owned(), |ps| format!("{ps:.3}")),
            number(result.n),
            number(result.t1_ns),
            if result.valid { "valid" } else { "none" }.to_owned(),
        ]);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("\n{}\n", table.trim_fmt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_000), "1,000");
        assert_eq!(grouped(12_345_678), "12,345,678");
    }
}
