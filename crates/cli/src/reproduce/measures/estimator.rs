//! Histogram builder and depth estimator: section 6.7.3, Fig. 6.12 to 6.14, 6.19 and 6.21.

use tofsim::error::Result;
use tofsim::sim::Run;

use crate::page::plot::{BLUE, Layer, ORANGE, Shape};
use crate::page::trace::Trace;
use crate::reproduce::peaks::SHOTS;
use crate::reproduce::scenes::View;
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

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
    let (_, seen) = study.captured("fig_6_21", &[])?;
    Ok(Trace::of_capture(&seen, 0..seen.samples().min(320), CYCLE_NS))
}

pub(super) fn steps(study: &Study) -> Result<Measured> {
    let mut trace = estimation(study)?;
    let values = Values::of_trace(&trace);
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

/// Period of `clk_laser` [ns].
const LASER_NS: f64 = 4.0;
/// Counts of bins 0 to 10, as far as the figure can be read; those of bins 3 to 6 are hard to [hits].
const PRINTED_COUNTS: [f64; 11] =
    [913.0, 952.0, 883.0, 843.0, 810.0, 810.0, 724.0, 793.0, 735.0, 695.0, 740.0];
/// Width of a bin [s].
const BIN_S: f64 = 25e-12;

pub(super) fn preload(study: &Study) -> Result<Measured> {
    let (_, seen) = study.captured("fig_6_12", &[])?;
    let trace = Trace::of_capture(&seen, 8..56, CYCLE_NS);
    Ok(Measured::from(Values::of_trace(&trace)).trace(trace))
}

pub(super) fn words(study: &Study) -> Result<Measured> {
    let (setup, seen) = study.captured("fig_6_13", &[])?;
    let end = seen.samples();
    let trace = Trace::of_capture(&seen, end.saturating_sub(24)..end, LASER_NS);
    let frames = Run::new(&setup).frames(1)?;
    let counted: Vec<u32> = frames.first().map_or(Vec::new(), |frame| frame.histogram.to_vec());
    let mut values = Values::default();
    for (bin, counted) in counted.iter().take(7).enumerate() {
        let name = format!("COUNTS[{bin}][15:0]");
        let wave = trace.waves.iter().find(|wave| wave.name == name);
        let word = wave.and_then(|wave| wave.samples.last()).cloned().unwrap_or_default();
        let counted = counted.to_string();
        values.put(format!("is_same.{bin}"), f64::from(word == counted));
        values.put_words(format!("word.{bin}"), word);
        values.put_words(format!("counted.{bin}"), counted);
    }
    Ok(Measured::from(values).trace(trace))
}

pub(super) fn printed(study: &Study) -> Result<Measured> {
    // The most ambient light of the specification, and a target that is far enough to leave the first bins alone.
    let view = View::new(study, 0.6, 0.6, 0.4)?;
    let expected: Vec<f64> = view.codes.of_code().iter().map(|p| SHOTS as f64 * p).collect();
    let mut values = Values::default();
    for (bin, (printed, expected)) in PRINTED_COUNTS.iter().zip(&expected).enumerate() {
        values.put_figure(format!("printed.{bin}"), (*printed, printed.sqrt()));
        values.put(format!("expected.{bin}"), *expected);
    }
    // The rate at which the printed counts in all are expected.
    let part = PRINTED_COUNTS.iter().sum::<f64>() / SHOTS as f64;
    let span_s = PRINTED_COUNTS.len() as f64 * BIN_S;
    let rate_ghz = -1e-9 * (1.0 - part).ln() / span_s;
    let error_ghz = 1e-9 * (part / SHOTS as f64).sqrt() / (1.0 - part) / span_s;
    values.put_figure("implied_ghz", (rate_ghz, error_ghz));
    values.put("ambient_hz", view.light().1);
    let by_bin = |counts: &[f64]| {
        let counts = counts.iter().take(PRINTED_COUNTS.len()).enumerate();
        counts.map(|(bin, count)| (bin as f64, *count)).collect::<Vec<_>>()
    };
    let layers = vec![
        Layer::new("thesis", ORANGE, Shape::Dots, by_bin(&PRINTED_COUNTS)),
        Layer::new("expected at 0.4 W/m^2/nm and 60 %", BLUE, Shape::Line, by_bin(&expected)),
    ];
    Ok(Measured::from(values).layers(layers))
}
