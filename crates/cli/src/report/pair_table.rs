//! Pairs of a dark and a lit frame as a table and as CSV.

use tofsim::sim::estimates::digits;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::subtraction::NAME;
use tofsim_learn::estimation::{Estimate, HistogramPair};

use crate::text::table::{facts, grouped, signed};

use super::frame_log::FrameLog;
use super::pairs::{PairStatistics, mean, right_of_echo};
use super::sheet::Digits::Shortest;
use super::sheet::Sheet;
use super::{readings, statistics};

/// The table of a run in pairs.
pub fn table(setup: &Setup, log: &FrameLog) -> String {
    match (log.rows.as_slice(), log.readings.as_slice()) {
        ([dark, lit], [_, readings]) => {
            let opinion = log.opinions.last().and_then(Option::as_ref);
            one_pair(setup, [dark, lit], readings, opinion)
        }
        _ => many_pairs(log),
    }
}

fn one_pair(
    setup: &Setup,
    [dark, lit]: [&Frame; 2],
    readings: &[Estimate],
    opinion: Option<&Estimate>,
) -> String {
    let mut rows = Vec::new();
    if let Some(truth) = setup.true_depth_m() {
        rows.push(("true depth", format!("{truth:.6} m")));
    }
    if let Some(opinion) = opinion {
        rows.push(("second opinion", statistics::in_words(opinion, setup.true_depths())));
    }
    rows.extend(readings::rows(setup, readings));
    let both = |of: &dyn Fn(&Frame) -> u64| {
        format!("{} dark, {} lit", grouped(of(dark)), grouped(of(lit)))
    };
    let difference = difference(dark, lit);
    let (least, most) = range(&difference);
    let sum: i32 = difference.iter().sum();
    rows.extend([
        ("shots", both(&|frame| frame.shots)),
        ("TDC hits", both(&|frame| frame.tdc_hits)),
        ("codes counted", both(&Frame::hits)),
        ("lit less dark", format!("{sum:+} hits, {least:+} to {most:+} in a bin")),
    ]);
    if let Some(bin) = right_of_echo(setup) {
        let hits = mean(&difference[bin..]);
        let text = format!("{} hits per bin on average, from bin {bin} on", signed(hits, 1));
        rows.push(("right of the echo", text));
    }
    let cycles = dark.frame_cycles + lit.frame_cycles + 1;
    let board_ms = cycles as f64 * setup.cycle().seconds() * 1e3;
    rows.extend([
        ("depth words", format!("{} dark, {} lit", digits(dark.depth()), digits(lit.depth()))),
        ("estimator", format!("{} cycles", lit.estimator_cycles)),
        ("pair", format!("{} cycles, {board_ms:.6} ms on the board", grouped(cycles))),
    ]);
    facts(rows)
}

fn many_pairs(log: &FrameLog) -> String {
    let shown = log.rows.chunks_exact(2).zip(log.readings.chunks_exact(2));
    let rows = shown.enumerate().map(|(index, (frames, readings))| {
        let (least, most) = range(&difference(&frames[0], &frames[1]));
        let [dark, lit] = [0, 1].map(|k| grouped(frames[k].hits()));
        let cells = vec![index.to_string(), dark, lit, format!("{least:+}"), format!("{most:+}")];
        (cells, &readings[1])
    });
    let count = log.pairs.as_ref().map_or(0, |pairs| pairs.statistics().count);
    let left = count.saturating_sub(log.rows.len() as u64 / 2);
    let header = ["pair", "codes dark", "codes lit", "least", "most"];
    readings::many(&header, log, rows, left, readings::below(log, header.len(), None))
}

/// Returns the statistics of many pairs, a line each.
pub fn lines(statistics: &PairStatistics) -> String {
    let mut text = String::new();
    if let Some(failures) = statistics.failures {
        text += &format!("{NAME}: {failures} failures in {} pairs", statistics.count);
        if let (Some(mean_m), Some(two_sd_m)) = (statistics.mean_m, statistics.two_sd_m) {
            text += &format!(", mean {mean_m:.6} m, 2σ {two_sd_m:.6} m");
        }
        text += "\n";
    }
    if let Some(hits) = statistics.right_of_echo {
        text += &format!("right of the echo: {} hits per bin on average\n", signed(hits, 2));
    }
    text
}

fn difference(dark: &Frame, lit: &Frame) -> Vec<i32> {
    HistogramPair { dark: dark.histogram.clone(), lit: lit.histogram.clone() }.difference()
}

fn range(difference: &[i32]) -> (i32, i32) {
    difference.iter().fold((0, 0), |(least, most), &hits| (least.min(hits), most.max(hits)))
}

/// Returns a pair as CSV, a row for each bin.
pub fn csv(dark: &Frame, lit: &Frame) -> String {
    let bins: Vec<_> = difference(dark, lit).into_iter().enumerate().collect();
    Sheet::of(&bins)
        .column("bin", Shortest, |(bin, _)| *bin)
        .column("dark", Shortest, |(bin, _)| dark.histogram[*bin])
        .column("lit", Shortest, |(bin, _)| lit.histogram[*bin])
        .column("difference", Shortest, |(_, hits)| *hits)
        .csv()
}
