//! The depth estimator's clocks: section 6.7.3, Fig. 6.19 and 6.21.

use tofsim::error::Result;
use tofsim::sim::Run;
use tofsim_captures::ila::AnalyserSetup;

use crate::page::trace::Trace;
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::scopes::captured;
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 3] = [
    Item::made("clocks", "Clocks of an estimation (section 6.7.3)", clocks),
    Item::made("fig-6.19", "The three steps of an estimation", steps),
    Item::made("fig-6.21", "An estimation, and its depth word", word),
];

const CYCLE_NS: f64 = 8.0;
/// The word that the figure shows, and its fraction bits.
const PRINTED: u64 = 0x0_1013_c199;
const FRACTION: u32 = 29;

fn clocks(study: &Study) -> Result<Finding> {
    let setup = study.setup("estimator_validation", &[])?;
    let cycles =
        Run::new(&setup).frames(1)?.first().map_or(f64::NAN, |frame| frame.estimator_cycles as f64);
    let board = study.setup("kc705", &["firmware.laser_freq=3"])?;
    let shots = f64::from(board.params.frame_ctrl.shots_per_frame) * board.laser_period() as f64;
    let frame_ms = shots * board.cycle().seconds() * 1e3;
    let rows = [
        Row::numbers("clocks of an estimation", "", Number::new(267.0, 0), Number::new(cycles, 0)),
        Row::numbers(
            "at 125 MHz",
            "us",
            Number::new(2.136, 3),
            Number::new(cycles * CYCLE_NS * 1e-3, 3),
        ),
        Row::numbers(
            "shortest time of a frame",
            "ms",
            Number::new(1.5, 1),
            Number::new(frame_ms, 2),
        ),
    ];
    let reason = "Counted in a simulation of the registers, from the edge that takes the start to the one that raises algo_done. The \
                  shortest frame is 30,000 periods of 6 cycles, which is what Table 6.1 has for 20 MHz, and so 20.8 MHz.";
    Ok(Finding::of(rows).because(reason).shown_by("tofsim verify --cycle-counts"))
}

/// The capture of Fig. 6.21, and where the steps are.
fn seen(study: &Study) -> Result<Trace> {
    let (_, seen) = captured(study, &AnalyserSetup::load("fig_6_21")?, &[])?;
    Ok(Trace::of_capture(&seen, 0..seen.samples().min(320), CYCLE_NS))
}

fn steps(study: &Study) -> Result<Finding> {
    let mut trace = seen(study)?;
    let begin = |name: &str| trace.rises_ns(name).first().copied().unwrap_or(f64::NAN);
    let names = ["FORWARD1_EN", "TANSIG_EN", "FORWARD2_EN", "ALGO_DONE"];
    let at = names.map(begin);
    let rows = [
        Row::claim(
            "the steps follow one another",
            at.is_sorted_by(|a, b| a < b),
            format!("{} ns", at.map(|ns| ns.to_string()).join(", ")),
        ),
        Row::ours_alone(
            "clocks of step 1, FORWARD1_EN",
            "",
            Number::new(trace.high(names[0]) as f64, 0),
        ),
        Row::ours_alone(
            "clocks of step 2, TANSIG_EN",
            "",
            Number::new(trace.high(names[1]) as f64, 0),
        ),
        Row::ours_alone(
            "clocks from FORWARD1_EN to ALGO_DONE",
            "",
            Number::new((at[3] - at[0]) / CYCLE_NS, 0),
        ),
    ];
    trace.waves.retain(|wave| {
        names.contains(&&*wave.name)
            || wave.name.starts_with("L1_IN[0]")
            || wave.name.starts_with("Depth")
    });
    trace.spans = vec![
        (at[0]..at[1], "(a) L1_IN".to_owned()),
        (at[1]..at[2], "(b) tansig".to_owned()),
        (at[2]..at[3], "(c) Depth".to_owned()),
    ];
    let words = "Step 1 sums products of weights and counts, step 2 looks the activations up, step 3 sums those.";
    let reason = "The drawing does not print the clocks of a step. The 267 in all are counted from the edge that takes the start (clocks).";
    Ok(Finding::of(rows).because(reason).with_trace(words, trace))
}

fn word(study: &Study) -> Result<Finding> {
    let trace = seen(study)?;
    let done = trace.rises_ns("ALGO_DONE").first().copied().unwrap_or(0.0);
    let sample = (done / CYCLE_NS) as usize;
    let shown = |name: &str| {
        let wave = trace.waves.iter().find(|wave| wave.name.starts_with(name));
        wave.and_then(|wave| wave.samples.get(sample)).cloned().unwrap_or_default()
    };
    let (depth, metres) = (shown("Depth"), |word: u64| word as f64 / f64::from(1u32 << FRACTION));
    let own = u64::from_str_radix(&depth, 16).unwrap_or(0);
    let rows = [
        Row::numbers(
            "digits of the word",
            "",
            Number::new(9.0, 0),
            Number::new(depth.len() as f64, 0),
        ),
        Row::claim(
            "the printed word, read with 29 fraction bits, is a depth of the range",
            (0.1..=0.6).contains(&metres(PRINTED)),
            format!("{PRINTED:09x} is {:.6} m", metres(PRINTED)),
        ),
        Row::words("depth word", format!("{PRINTED:09x}"), depth),
        Row::ours_alone("ours", "m", Number::new(metres(own), 6)),
    ];
    let reason = "Another histogram and another network: the thesis publishes neither. Its word reads as 0.502412 m in the format \
                  that follows from Table 6.4; ours is that of the histogram stimuli/histograms/kc705.csv, of a target at 0.5 m.";
    Ok(Finding::of(rows)
        .because(reason)
        .with_trace("The set-up fig_6_21, an analyser at 125 MHz.", trace)
        .shown_by("tofsim ila capture --probes fig_6_21 -o out"))
}
