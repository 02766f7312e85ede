//! Frames of a board: a table, and files with depth and histogram of each.
//!
//! Columns of `frames.csv` and `frames.parquet`: `frame`, `depth_m`, `depth_raw` (the word, 2^-29 m), `sigma_m` (empty or
//! null where the estimator states none), `valid`, `status` (words, separated by semicolons), `hits`, `b0` .. `b255`.
//! `histograms.npy` has n x bins `u32`, `depths.npy` n x 2 `f64`: depth and sigma [m].

mod files;

pub use files::{Formats, FrameFiles};

use tofsim::sim::estimates::{Estimate, digits};
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;

use crate::text::table::{fixed, grouped, number_or_dash};

use super::frame_log::FrameLog;
use super::sheet::Digits::{Fixed, Shortest};
use super::sheet::Sheet;
use super::statistics;

/// Returns the table of the first frames, and statistics of all.
pub fn table(setup: &Setup, log: &FrameLog) -> String {
    let sheet = Sheet::of(&log.rows)
        .both(("frame", Shortest), ("frame", Shortest), |frame| frame.index)
        .both(("depth_m", Shortest), ("depth [m]", Fixed(6)), Frame::depth_m)
        .words("word", |frame| digits(frame.depth()))
        .words("sigma [mm]", |frame| {
            number_or_dash(frame.estimate().sigma_m.map(|sigma_m| 1e3 * sigma_m), 3)
        })
        .words("hits", |frame| grouped(frame.hits()))
        .words("status", |frame| status(&frame.estimate()));
    let mut text = format!("{}: {}\n\n", setup.name, setup.params.estimator.name());
    text += &sheet.table();
    let more = log.count - log.rows.len() as u64;
    if more > 0 {
        text += &format!("\n... and {} more", grouped(more));
    }
    if let Some(spread) = log.spread() {
        let (mean, two_sigma) = (fixed(spread.mean_m, 6), fixed(1e3 * spread.two_sd_m, 3));
        text += &format!("\n\nmean {mean} m, 2 sigma {two_sigma} mm over {} frames", log.count);
    }
    if let Some(second) = log.second_opinion() {
        text += &format!("\n\n{}", statistics::line(&second));
    }
    text + "\n"
}

/// Returns the status in words.
fn status(estimate: &Estimate) -> String {
    estimate.rejection().unwrap_or_else(|| "-".to_owned())
}
