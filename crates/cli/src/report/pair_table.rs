//! Pairs of a dark and a lit frame as a table and as CSV.

use comfy_table::{CellAlignment, Table};

use tofsim::firmware::histogram_builder::BINS;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::{CYCLE, Setup};
use tofsim_learn::estimation::subtraction::NAME;
use tofsim_learn::estimation::{Pair, Reading};

use super::frame_log::FrameLog;
use super::pairs::{Pairs, Tally, mean, right_of_echo};
use super::table::{depth_or_failure, readings as rows_of_readings};
use crate::text::table::{grouped, plain};

/// The table of a run in pairs.
pub fn table(setup: &Setup, log: &FrameLog) -> Table {
    match (log.rows.as_slice(), log.readings.as_slice()) {
        ([dark, lit], [_, readings]) => one_pair(setup, dark, lit, readings),
        _ => many_pairs(log),
    }
}

fn one_pair(setup: &Setup, dark: &Frame, lit: &Frame, readings: &[Reading]) -> Table {
    let mut table = plain();
    let mut row = |name: &str, value: String| {
        table.add_row([name.to_owned(), value]);
    };
    if let Some(truth) = setup.true_depth_m() {
        row("true depth", format!("{truth:.6} m"));
    }
    rows_of_readings(setup, readings, &mut row);
    let both = |of: &dyn Fn(&Frame) -> u64| {
        format!("{} dark, {} lit", grouped(of(dark)), grouped(of(lit)))
    };
    row("shots", both(&|frame| frame.shots));
    row("TDC hits", both(&|frame| frame.tdc_hits));
    row("codes counted", both(&Frame::hits));
    let difference = Pair { dark: dark.histogram, lit: lit.histogram }.difference();
    let (least, most) = range(&difference);
    let sum: i32 = difference.iter().sum();
    row("lit less dark", format!("{sum:+} hits, {least:+} to {most:+} in a bin"));
    if let Some(bin) = right_of_echo(setup) {
        let hits = mean(&difference[bin..]);
        row("right of the echo", format!("{hits:+.1} hits in a bin on average, from bin {bin} on"));
    }
    row("depth words", format!("{:09x} dark, {:09x} lit", dark.depth.bits(), lit.depth.bits()));
    row("estimator", format!("{} cycles", lit.estimator_cycles));
    let cycles = dark.frame_cycles + lit.frame_cycles + 1;
    let board_ms = cycles as f64 * CYCLE.seconds() * 1e3;
    row("pair", format!("{} cycles, {board_ms:.6} ms on the board", grouped(cycles)));
    table
}

fn many_pairs(log: &FrameLog) -> Table {
    let mut table = plain();
    let columns = ["pair", "codes dark", "codes lit", "least", "most"].map(str::to_owned);
    let asked = log.readings.iter().rfind(|readings| !readings.is_empty());
    let names = asked.into_iter().flatten().map(|reading| reading.estimator.to_owned());
    table.set_header(columns.into_iter().chain(names));
    let shown = log.rows.chunks_exact(2).zip(log.readings.chunks_exact(2));
    for (index, (frames, readings)) in shown.enumerate() {
        let difference = Pair { dark: frames[0].histogram, lit: frames[1].histogram }.difference();
        let (least, most) = range(&difference);
        let mut cells = vec![
            index.to_string(),
            grouped(frames[0].hits()),
            grouped(frames[1].hits()),
            format!("{least:+}"),
            format!("{most:+}"),
        ];
        cells.extend(readings[1].iter().map(depth_or_failure));
        table.add_row(cells);
    }
    let tally = log.pairs.as_ref().map(Pairs::tally).unwrap_or_default();
    if tally.count > log.rows.len() as u64 / 2 {
        table.add_row([format!("... {} more", tally.count - log.rows.len() as u64 / 2)]);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// What many pairs came to, a line each.
pub fn lines(tally: &Tally) -> String {
    let mut text = String::new();
    if let Some(failures) = tally.failures {
        text += &format!("{NAME}: {failures} failures in {} pairs", tally.count);
        if let (Some(mean_m), Some(two_sd_m)) = (tally.mean_m, tally.two_sd_m) {
            text += &format!(", mean {mean_m:.6} m, 2 sd {two_sd_m:.6} m");
        }
        text += "\n";
    }
    if let Some(hits) = tally.right_of_echo {
        text += &format!("right of the echo: {hits:+.2} hits in a bin on average\n");
    }
    text
}

fn range(difference: &[i32; BINS]) -> (i32, i32) {
    difference.iter().fold((0, 0), |(least, most), &hits| (least.min(hits), most.max(hits)))
}

/// A pair as CSV: `bin,dark,lit,difference`, 256 rows.
pub fn csv(dark: &Frame, lit: &Frame) -> Vec<u8> {
    let pair = Pair { dark: dark.histogram, lit: lit.histogram };
    let mut text = "bin,dark,lit,difference\n".to_owned();
    for (bin, hits) in pair.difference().into_iter().enumerate() {
        text += &format!("{bin},{},{},{hits}\n", pair.dark[bin], pair.lit[bin]);
    }
    text.into_bytes()
}
