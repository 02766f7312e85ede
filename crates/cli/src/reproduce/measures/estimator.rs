//! The depth estimator's clocks: section 6.7.3, Fig. 6.19 and 6.21.

use tofsim::error::Result;
use tofsim::sim::Run;

use crate::page::trace::Trace;
use crate::reproduce::measured::Measured;
use crate::reproduce::scopes::{captured, of_trace};
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Period of `clk_sys` [ns].
const CYCLE_NS: f64 = 8.0;
/// The word that Fig. 6.21 shows.
const PRINTED: u64 = 0x0_1013_c199;
/// Fraction bits of a depth word.
const FRACTION: u32 = 29;

pub(super) fn clocks(study: &Study) -> Result<Measured> {
    let setup = study.setup("estimator_validation", &[])?;
    let frames = Run::new(&setup).frames(1)?;
    let board = study.setup("kc705", &["firmware.laser_freq=3"])?;
    let shots = f64::from(board.params.frame_ctrl.shots_per_frame) * board.laser_period() as f64;
    let mut values = Values::default();
    values.put("cycles", frames.first().map_or(f64::NAN, |frame| frame.estimator_cycles as f64));
    values.put("frame_ms", shots * board.cycle().seconds() * 1e3);
    Ok(values.into())
}

/// The capture of Fig. 6.21.
fn estimation(study: &Study) -> Result<Trace> {
    let (_, seen) = captured(study, "fig_6_21", &[])?;
    Ok(Trace::of_capture(&seen, 0..seen.samples().min(320), CYCLE_NS))
}

pub(super) fn steps(study: &Study) -> Result<Measured> {
    let mut trace = estimation(study)?;
    let values = of_trace(&trace);
    let names = ["FORWARD1_EN", "TANSIG_EN", "FORWARD2_EN", "ALGO_DONE"];
    let steps = ["(a) L1_IN", "(b) tansig", "(c) Depth"];
    let begins = names.map(|name| trace.rises_ns(name).first().copied().unwrap_or(f64::NAN));
    let spans = begins.windows(2).zip(steps);
    trace.spans = spans.map(|(ends, step)| (ends[0]..ends[1], step.to_owned())).collect();
    trace.waves.retain(|wave| {
        names.contains(&&*wave.name)
            || wave.name.starts_with("L1_IN[0]")
            || wave.name.starts_with("Depth")
    });
    Ok(Measured::from(values).trace(trace))
}

pub(super) fn depth_word(study: &Study) -> Result<Measured> {
    let trace = estimation(study)?;
    let done = trace.rises_ns("ALGO_DONE").first().copied().unwrap_or(0.0);
    let sample = (done / CYCLE_NS) as usize;
    let wave = trace.waves.iter().find(|wave| wave.name.starts_with("Depth"));
    let depth = wave.and_then(|wave| wave.samples.get(sample)).cloned().unwrap_or_default();
    let metres = |word: u64| word as f64 / f64::from(1u32 << FRACTION);
    let mut values = Values::default();
    values.put_words("printed", format!("{PRINTED:09x}"));
    values.put("printed_m", metres(PRINTED));
    values.put("digits", depth.len() as f64);
    values.put("depth_m", metres(u64::from_str_radix(&depth, 16).unwrap_or(0)));
    values.put_words("depth", depth);
    Ok(Measured::from(values).trace(trace))
}
