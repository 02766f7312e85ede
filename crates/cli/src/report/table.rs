//! The short table that a run prints.

use std::time::Duration;

use tofsim::sim::frames::Frame;
use tofsim::sim::setup::{CYCLE, Setup};
use tofsim_learn::estimation::Reading;

use crate::text::table::{facts, grouped, number_or_dash, table};

use super::frame_log::{DepthSpread, FrameLog};
use super::summary::TdcSummary;
use super::{pair_table, readings};

/// What came of a run, in a dozen lines.
pub fn run(setup: &Setup, log: &FrameLog, cycles: u64, wall: Duration) -> String {
    // A description is of the scenario as its file has it.
    let mut text = match &setup.set[..] {
        [] => format!("{}: {}\n\n", setup.name, setup.scenario.description),
        set => format!("{} with {}\n\n", setup.name, set.join(", ")),
    };
    match log.rows.as_slice() {
        _ if log.pairs.is_some() => text += &pair_table::table(setup, log),
        [frame] => text += &one_frame(setup, frame, &log.readings[0]),
        _ => text += &many_frames(log),
    }
    if let (Some(pairs), 3..) = (&log.pairs, log.count) {
        text += &format!("\n\n{}", pair_table::lines(&pairs.statistics()).trim_end());
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

fn one_frame(setup: &Setup, frame: &Frame, readings: &[Reading]) -> String {
    let mut rows = Vec::new();
    let mut estimated = format!("{:.6} m  {:09x}", frame.depth_m(), frame.depth.bits());
    if let Some(truth) = setup.true_depth_m() {
        rows.push(("true depth", format!("{truth:.6} m")));
        estimated += &format!("  {:+.2} mm", (frame.depth_m() - truth) * 1e3);
    }
    rows.push(("estimated", estimated));
    rows.extend(readings::rows(setup, readings));
    let cycles = grouped(frame.frame_cycles);
    let board_ms = frame.frame_cycles as f64 * CYCLE.seconds() * 1e3;
    rows.extend([
        ("shots", grouped(frame.shots)),
        ("TDC hits", grouped(frame.tdc_hits)),
        ("codes counted", grouped(frame.hits())),
        ("estimator", format!("{} cycles", frame.estimator_cycles)),
        ("frame", format!("{cycles} cycles, {board_ms:.6} ms on the board")),
    ]);
    facts(rows)
}

fn many_frames(log: &FrameLog) -> String {
    let header = ["frame", "depth [m]", "word", "TDC hits", "codes", "estimator", "cycles"];
    let rows = log.rows.iter().zip(&log.readings).map(|(frame, readings)| {
        let cells = vec![
            frame.index.to_string(),
            format!("{:.6}", frame.depth_m()),
            format!("{:09x}", frame.depth.bits()),
            grouped(frame.tdc_hits),
            grouped(frame.hits()),
            frame.estimator_cycles.to_string(),
            grouped(frame.frame_cycles),
        ];
        (cells, readings)
    });
    let spread = log.spread().map(|DepthSpread { mean_m, two_sd_m }| {
        [("mean", mean_m), ("2 sd", two_sd_m)].map(|(n, m)| vec![n.to_owned(), format!("{m:.6}")])
    });
    let below = spread.into_iter().flatten().collect();
    readings::many(&header, log, rows, log.count - log.rows.len() as u64, below)
}

/// Thesis Table 6.3.
pub fn tdc(results: &[TdcSummary]) -> String {
    let number = |value: Option<u64>| value.map_or("-".to_owned(), |value| value.to_string());
    let rows = results.iter().map(|result| {
        [
            number_or_dash(result.t2_ps, 3),
            number(result.n),
            number(result.t1_ns),
            if result.valid { "valid" } else { "none" }.to_owned(),
        ]
    });
    format!("\n{}\n", table(["T2 [ps]", "N", "T1 [ns]", "code"], rows, ..))
}
