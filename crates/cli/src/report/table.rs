//! The short table that a run prints.

use std::time::Duration;

use tofsim::sim::estimates::digits;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::truth::TrueDepths;

use crate::text::table::{facts, grouped, number_or_dash, signed_or_dash, table};

use super::frame_log::{DepthSpread, FrameLog};
use super::summary::{Summary, TdcSummary};
use super::{pair_table, readings, statistics};

/// Returns the results of a run in a dozen lines.
///
/// `cycles` is what was simulated in the time `wall`; none for frames that were drawn at once.
pub fn run(
    setup: &Setup,
    log: &FrameLog,
    summary: &Summary,
    cycles: Option<u64>,
    wall: Duration,
) -> String {
    // A description is of the scenario as its file has it.
    let mut text = match &setup.set[..] {
        [] => format!("{}: {}\n\n", setup.name, setup.scenario.description),
        set => format!("{} with {}\n\n", setup.name, set.join(", ")),
    };
    match log.rows.as_slice() {
        _ if log.pairs.is_some() => text += &pair_table::table(setup, log),
        [frame] => text += &one_frame(setup, frame, log),
        _ => text += &many_frames(log),
    }
    if let (Some(pairs), 3..) = (&log.pairs, log.count) {
        text += &format!("\n\n{}", pair_table::lines(&pairs.statistics()).trim_end());
    }
    if let Some(second) = log.second_opinion() {
        text += &format!("\n\n{}", statistics::line(&second));
    }
    let wall_ms = wall.as_secs_f64() * 1e3;
    text += &match cycles {
        Some(cycles) => format!(
            "\n\n{} cycles in {wall_ms:.1} ms: {:.1} million cycles per second\n",
            grouped(cycles),
            cycles as f64 / wall.as_secs_f64() / 1e6,
        ),
        None => {
            let things = if log.count == 1 { "frame" } else { "frames" };
            format!("\n\n{} {things} drawn in {wall_ms:.1} ms\n", grouped(log.count))
        }
    };
    text + &summary.tdc.as_deref().map_or(String::new(), tdc)
}

fn one_frame(setup: &Setup, frame: &Frame, log: &FrameLog) -> String {
    let mut rows = Vec::new();
    let truth = setup.true_depths();
    if let Some(TrueDepths { first_m, second_m }) = truth {
        let second = second_m.map_or(String::new(), |m| format!(", second target {m:.6} m"));
        rows.push(("true depth", format!("{first_m:.6} m{second}")));
    }
    rows.push(("estimated", statistics::in_words(&frame.estimate(), truth)));
    if let Some(opinion) = &log.opinions[0] {
        rows.push(("second opinion", statistics::in_words(opinion, truth)));
    }
    rows.extend(readings::rows(setup, &log.readings[0]));
    let cycles = grouped(frame.frame_cycles);
    let board_ms = frame.frame_cycles as f64 * setup.cycle().seconds() * 1e3;
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
            digits(frame.depth()),
            grouped(frame.tdc_hits),
            grouped(frame.hits()),
            frame.estimator_cycles.to_string(),
            grouped(frame.frame_cycles),
        ];
        (cells, readings)
    });
    let below = log.spread().map_or(Vec::new(), |spread| below(&spread, header.len(), log));
    readings::many(&header, log, rows, log.count - log.rows.len() as u64, below)
}

/// Returns the rows with the statistics of all frames, of `cells` cells and one for each other estimator.
fn below(own: &DepthSpread, cells: usize, log: &FrameLog) -> Vec<Vec<String>> {
    let metres = |m: f64| format!("{m:.6}");
    let error = signed_or_dash(own.mean_error_m.map(|m| 1e3 * m), 3);
    let (mean, two_sd, outliers) =
        (metres(own.mean_m), metres(own.two_sd_m), own.outliers.to_string());
    let own_cells = [mean, two_sd, error, outliers, "-".to_owned()];
    let truth = own.true_depth_m.map(|m| vec!["truth".to_owned(), metres(m)]);
    truth.into_iter().chain(readings::below(log, cells, Some(own_cells))).collect()
}

/// Thesis Table 6.3.
fn tdc(results: &[TdcSummary]) -> String {
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
