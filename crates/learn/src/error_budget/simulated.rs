//! Histograms of frames that are simulated shot by shot, where shots depend on each other.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::network::Histogram;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::{Observers, Run};
use tofsim::sim::setup::Setup;

/// The histograms of so many frames; `done` hears of each.
///
/// # Errors
/// When it is stopped.
pub fn frames(
    setup: &Setup,
    count: u64,
    stop: Option<&AtomicBool>,
    done: &dyn Fn(u64),
) -> Result<Vec<Histogram>> {
    let mut histograms = Vec::with_capacity(count as usize);
    let mut take = |frame: &Frame| {
        histograms.push(frame.histogram.clone());
        done(1);
        Ok(())
    };
    Run::new(setup)
        .many(count, Observers { frames: Some(&mut take), stop, ..Observers::default() })?;
    Ok(histograms)
}
