//! The histogram builder: Fig. 6.12 to 6.14.

use tofsim::error::Result;
use tofsim_captures::ila::AnalyserSetup;

use crate::page::plot::{BLUE, Layer, ORANGE, Plot, Shape};
use crate::page::trace::Trace;
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::peaks::SHOTS;
use crate::reproduce::scenes::View;
use crate::reproduce::scopes::captured;
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 3] = [
    Item::made("fig-6.12", "A preloaded code into the histogram", preload),
    Item::made("fig-6.13", "The first counts of the histogram", words),
    Item::made("fig-6.14", "Counts of the analyser and of MATLAB", printed),
];

/// Periods of `clk_sys` and `clk_laser` [ns].
const CYCLE_NS: f64 = 8.0;
const LASER_NS: f64 = 4.0;
/// Counts of bins 0 to 10, as far as the figure can be read; those of bins 3 to 6 are hard to.
const PRINTED: [f64; 11] =
    [913.0, 952.0, 883.0, 843.0, 810.0, 810.0, 724.0, 793.0, 735.0, 695.0, 740.0];

fn preload(study: &Study) -> Result<Finding> {
    let (_, seen) = captured(study, &AnalyserSetup::load("fig_6_12")?, &[])?;
    let trace = Trace::of_capture(&seen, 8..56, CYCLE_NS);
    let (on, valid) = (trace.rises_ns("VCSEL_ON"), trace.rises_ns("TDC_VALID"));
    let later = on.first().zip(valid.first()).map_or(f64::NAN, |(on, valid)| valid - on);
    let rows = [
        Row::numbers(
            "from the laser edge to the code",
            "ns",
            Number::new(10.0, 0),
            Number::new(later, 0),
        ),
        Row::claim(
            "a code follows each laser edge",
            valid.len() + 1 >= on.len(),
            format!("{} codes after {} edges", valid.len(), on.len()),
        ),
    ];
    let reason = "10 ns are no whole number of cycles of 125 MHz: here the ROM gives its code at the second edge after the laser's, \
                  the first one at which 10 ns have gone by.";
    Ok(Finding::of(rows)
        .because(reason)
        .with_trace("The set-up fig_6_12, an analyser at 125 MHz.", trace)
        .shown_by("tofsim ila capture --probes fig_6_12 -o out"))
}

fn words(study: &Study) -> Result<Finding> {
    let (setup, seen) = captured(study, &AnalyserSetup::load("fig_6_13")?, &[])?;
    let end = seen.samples();
    let trace = Trace::of_capture(&seen, end.saturating_sub(24)..end, LASER_NS);
    let codes = tofsim::sim::Run::new(&setup).frames(1)?;
    let expected: Vec<u32> = codes.first().map_or(Vec::new(), |frame| frame.histogram.to_vec());
    let rows = (0..7).map(|bin| {
        let name = format!("COUNTS[{bin}][15:0]");
        let wave = trace.waves.iter().find(|wave| wave.name == name);
        let seen = wave.and_then(|wave| wave.samples.last()).cloned().unwrap_or_default();
        let counted = expected.get(bin).map_or(String::new(), u32::to_string);
        Row::claim(
            format!("the RAM's word {bin} is what was counted of the codes"),
            seen == counted && !seen.is_empty(),
            format!("{seen}, and {counted} of the codes"),
        )
    });
    let reason = "The counts themselves are those of the codes that are put in, which the thesis does not publish (Fig. 6.14).";
    Ok(Finding::of(rows)
        .because(reason)
        .with_trace("The set-up fig_6_13: the first words as the acquisition ends.", trace)
        .shown_by("tofsim ila capture --probes fig_6_13 -o out"))
}

fn printed(study: &Study) -> Result<Finding> {
    // The most ambient light of the specification, and a target that is far enough to leave the first bins alone.
    let view = View::new(study, 0.6, 0.6, 0.4)?;
    let expected: Vec<f64> = view.codes.of_code().iter().map(|p| SHOTS as f64 * p).collect();
    let (_, ambient_hz) = view.light();
    let mut rows: Vec<_> = PRINTED
        .into_iter()
        .zip(&expected)
        .enumerate()
        .map(|(bin, (printed, ours))| {
            let thesis = Number::new(printed, 0).with_error(printed.sqrt());
            Row::numbers(format!("count of bin {bin}"), "", thesis, Number::new(*ours, 0))
        })
        .collect();
    // The rate at which the printed counts in all are expected.
    let part = PRINTED.iter().sum::<f64>() / SHOTS as f64;
    let span_s = PRINTED.len() as f64 * 25e-12;
    let rate_ghz = -1e-9 * (1.0 - part).ln() / span_s;
    let error_ghz = 1e-9 * (part / SHOTS as f64).sqrt() / (1.0 - part) / span_s;
    let own = Number::new(1e-9 * ambient_hz, 3);
    rows.push(Row::numbers(
        "rate of noise that the counts imply, at 30,000 shots",
        "GHz",
        Number::new(rate_ghz, 2).with_error(error_ghz),
        own,
    ));
    let by = |counts: &[f64]| {
        counts
            .iter()
            .take(11)
            .enumerate()
            .map(|(bin, count)| (bin as f64, *count))
            .collect::<Vec<_>>()
    };
    let layers = vec![
        Layer::new("thesis", ORANGE, Shape::Dots, by(&PRINTED)),
        Layer::new("expected at 0.4 W/m^2/nm and 60 %", BLUE, Shape::Line, by(&expected)),
    ];
    let plot = Plot { title: "The first bins", axes: ["bin", "hits"], layers };
    let reason = "Not reconciled. 30,000 shots with these counts have 1.28 avalanches a nanosecond, more than the 0.95 that the most \
                  ambient light of the specification gives with the rate fitted to Table 4.3; with that peak detection would \
                  fail thousands of times at 0.5 m, and Table 4.3 has 332. So the histogram was taken with other settings, or \
                  the figure is misread: its text is hard to read in bins 3 to 6. Nothing here is fitted to it.";
    Finding::of(rows).because(reason).with_plot(&plot, "Counts as printed, and as expected.")
}
