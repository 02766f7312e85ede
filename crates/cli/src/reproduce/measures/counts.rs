//! The histogram builder: Fig. 6.12 to 6.14.

use tofsim::error::Result;
use tofsim::sim::Run;

use crate::page::plot::{BLUE, Layer, ORANGE, Shape};
use crate::page::trace::Trace;
use crate::reproduce::measured::Measured;
use crate::reproduce::peaks::SHOTS;
use crate::reproduce::scenes::View;
use crate::reproduce::scopes::{captured, of_trace};
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Periods of `clk_sys` and `clk_laser` [ns].
const CYCLE_NS: f64 = 8.0;
const LASER_NS: f64 = 4.0;
/// Counts of bins 0 to 10, as far as the figure can be read; those of bins 3 to 6 are hard to [hits].
const PRINTED: [f64; 11] =
    [913.0, 952.0, 883.0, 843.0, 810.0, 810.0, 724.0, 793.0, 735.0, 695.0, 740.0];
/// Width of a bin [s].
const BIN_S: f64 = 25e-12;

pub(super) fn preload(study: &Study) -> Result<Measured> {
    let (_, seen) = captured(study, "fig_6_12", &[])?;
    let trace = Trace::of_capture(&seen, 8..56, CYCLE_NS);
    Ok(Measured::from(of_trace(&trace)).trace(trace))
}

pub(super) fn words(study: &Study) -> Result<Measured> {
    let (setup, seen) = captured(study, "fig_6_13", &[])?;
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
    for (bin, (printed, expected)) in PRINTED.iter().zip(&expected).enumerate() {
        values.put_figure(format!("printed.{bin}"), (*printed, printed.sqrt()));
        values.put(format!("expected.{bin}"), *expected);
    }
    // The rate at which the printed counts in all are expected.
    let part = PRINTED.iter().sum::<f64>() / SHOTS as f64;
    let span_s = PRINTED.len() as f64 * BIN_S;
    let rate_ghz = -1e-9 * (1.0 - part).ln() / span_s;
    let error_ghz = 1e-9 * (part / SHOTS as f64).sqrt() / (1.0 - part) / span_s;
    values.put_figure("implied_ghz", (rate_ghz, error_ghz));
    values.put("ambient_hz", view.light().1);
    let by_bin = |counts: &[f64]| {
        let counts = counts.iter().take(PRINTED.len()).enumerate();
        counts.map(|(bin, count)| (bin as f64, *count)).collect::<Vec<_>>()
    };
    let layers = vec![
        Layer::new("thesis", ORANGE, Shape::Dots, by_bin(&PRINTED)),
        Layer::new("expected at 0.4 W/m^2/nm and 60 %", BLUE, Shape::Line, by_bin(&expected)),
    ];
    Ok(Measured::from(values).layers(layers))
}
