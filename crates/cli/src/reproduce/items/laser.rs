//! Laser and SPAD control: Tables 6.1 and 6.2, Fig. 6.3 and 6.6.

use tofsim::error::Result;
use tofsim_captures::ila::AnalyserSetup;

use crate::page::trace::Trace;
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::scopes::{captured, captured_by};
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 4] = [
    Item::made("table-6.1", "Periods of the laser", periods),
    Item::made("fig-6.3", "LASER_ON at the four repetition rates", rates),
    Item::made("table-6.2", "SPAD modes", modes),
    Item::made("fig-6.6", "Trigger of the laser and reset of the SPAD", trigger),
];

/// Rates that the thesis asks for [MHz], and cycles of 125 MHz that it takes (Table 6.1).
const RATES: [(f64, f64); 4] = [(5.0, 25.0), (10.0, 13.0), (15.0, 8.0), (20.0, 6.0)];
/// Period of `clk_laser` [ns].
const LASER_NS: f64 = 4.0;

/// The laser's enable, the reset and the light, as a 250 MHz and a 1 GHz analyser see them.
const SCOPE: &str = "scenario = \"kc705\"\nclock = \"clk_laser\"\ndepth = 1024\narm_at_us = 10\n\
    trigger = \"laser_pulse rising\"\n\
    [[probe]]\nname = \"laser_pulse\"\nsignal = \"vcsel_driver.laser_pulse\"\n\
    [[probe]]\nname = \"spad_rst\"\nsignal = \"spad_rst\"\n";

/// What is seen at a rate.
fn at_rate(study: &Study, rate: usize, more: &[&str]) -> Result<Trace> {
    let rate = format!("firmware.laser_freq={rate}");
    let set: Vec<_> = [rate.as_str()].into_iter().chain(more.iter().copied()).collect();
    let (_, seen) = captured_by(study, SCOPE, &set)?;
    Ok(Trace::of_capture(&seen, 0..seen.samples(), LASER_NS))
}

/// Between two pulses of the laser, and whether all are as far apart [ns].
fn period_ns(trace: &Trace) -> (f64, bool) {
    let rises = trace.rises_ns("laser_pulse");
    let apart: Vec<_> = rises.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let first = apart.first().copied().unwrap_or(f64::NAN);
    (first, apart.iter().all(|one| *one == first))
}

fn periods(study: &Study) -> Result<Finding> {
    let mut rows = Vec::new();
    for (k, (mhz, cycles)) in RATES.into_iter().enumerate() {
        let (period_ns, is_even) = period_ns(&at_rate(study, k, &[])?);
        let ours = if is_even { period_ns / 8.0 } else { f64::NAN };
        let printed = Number::new(cycles, 0);
        rows.push(Row::numbers(format!("cycles for {mhz} MHz"), "", printed, Number::new(ours, 0)));
        rows.push(Row::ours_alone(
            format!("rate that {cycles} cycles come to"),
            "MHz",
            Number::new(1e3 / period_ns, 3),
        ));
    }
    let reason = "Counted between pulses in a simulation of the firmware, 1,024 samples at each rate. 13, 8 and 6 cycles are \
                  9.6, 15.6 and 20.8 MHz.";
    Ok(Finding::of(rows).because(reason))
}

fn rates(study: &Study) -> Result<Finding> {
    let mut all = Trace { step_ns: LASER_NS, ..Trace::default() };
    let mut rows = Vec::new();
    for (k, (mhz, cycles)) in RATES.into_iter().enumerate() {
        let one = at_rate(study, k, &[])?;
        let (period, _) = period_ns(&one);
        rows.push(Row::numbers(
            format!("cycles between pulses at {mhz} MHz"),
            "",
            Number::new(cycles, 0),
            Number::new(period / 8.0, 0),
        ));
        let first = one.rises_ns("laser_pulse").first().copied().unwrap_or(0.0) / LASER_NS;
        let mut wave = one.waves[0].clone();
        wave.samples = wave.samples.into_iter().skip(first as usize).take(120).collect();
        wave.name = format!("{mhz} MHz");
        all.waves.push(wave);
    }
    let words = "laser_pulse, which enables the light, at each rate, from a pulse on; an analyser at 250 MHz samples it. The \
                 light itself is on for 2 ns after it.";
    Ok(Finding::of(rows).with_trace(words, all))
}

fn modes(study: &Study) -> Result<Finding> {
    let trace = at_rate(study, 3, &["firmware.mode=0"])?;
    let (resets, pulses) = (trace.rises_ns("spad_rst"), trace.rises_ns("laser_pulse"));
    // The laser edge ends the `clk_laser` cycle in which `laser_pulse` is high.
    let lead = |edge: f64| {
        let before = resets.iter().rev().find(|reset| **reset < edge);
        before.map_or(f64::NAN, |reset| edge - reset)
    };
    let leads: Vec<_> = pulses.iter().skip(1).map(|pulse| lead(pulse + LASER_NS)).collect();
    let first = leads.first().copied().unwrap_or(f64::NAN);
    let is_even = leads.iter().all(|lead| *lead == first);
    let free = at_rate(study, 3, &["firmware.mode=1"])?;
    let rows = [
        Row::numbers(
            "MODE 0: reset before the laser edge",
            "ns",
            Number::new(8.0, 0),
            Number::new(if is_even { first } else { f64::NAN }, 0),
        ),
        Row::claim(
            "MODE 1: no reset",
            free.high("spad_rst") == 0,
            format!("{} of {} samples", free.high("spad_rst"), free.samples()),
        ),
    ];
    Ok(Finding::of(rows).shown_by("tofsim run spad_validation -o out"))
}

fn trigger(study: &Study) -> Result<Finding> {
    let (_, seen) = captured(study, &AnalyserSetup::load("fig_6_6")?, &[])?;
    let whole = Trace::of_capture(&seen, 0..seen.samples(), LASER_NS);
    let (resets, pulses) = (whole.rises_ns("SPAD_RST_DO"), whole.rises_ns("VCSEL_ON"));
    let each = pulses
        .iter()
        .skip(1)
        .all(|pulse| resets.iter().any(|reset| (pulse - 2.0 * LASER_NS..=*pulse).contains(reset)));
    let rows = [Row::claim(
        "the SPAD is reset before the laser is on, each time",
        each && pulses.len() > 1,
        format!("{} triggers", pulses.len()),
    )];
    let middle = seen.triggers.first().copied().unwrap_or(0);
    let from = middle.saturating_sub(8);
    let words = "The set-up fig_6_6: an analyser at 250 MHz sees the laser's trigger, and the reset before it.";
    Ok(Finding::of(rows)
        .with_trace(words, Trace::of_capture(&seen, from..from + 64, LASER_NS))
        .shown_by("tofsim ila capture --probes fig_6_6 -o out"))
}
