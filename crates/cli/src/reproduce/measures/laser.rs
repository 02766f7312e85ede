//! Laser and SPAD control: Tables 6.1 and 6.2, Fig. 6.3 and 6.6.

use tofsim::error::Result;

use crate::page::trace::Trace;
use crate::reproduce::measured::Measured;
use crate::reproduce::scopes::{captured, captured_by};
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Rates that the thesis asks for, in the order of `firmware.laser_freq` [MHz].
const RATES_MHZ: [&str; 4] = ["5", "10", "15", "20"];
/// Period of `clk_laser` [ns].
const LASER_NS: f64 = 4.0;
/// Samples of a rate that are drawn.
const DRAWN: usize = 120;

/// The laser's enable and the reset, as a 250 MHz analyser sees them.
const SCOPE: &str = "scenario = \"kc705\"\nclock = \"clk_laser\"\ndepth = 1024\narm_at_us = 10\n\
    trigger = \"laser_pulse rising\"\n\
    [[probe]]\nname = \"laser_pulse\"\nsignal = \"vcsel_driver.laser_pulse\"\n\
    [[probe]]\nname = \"spad_rst\"\nsignal = \"spad_rst\"\n";

/// Captures a rate, by its place.
fn at_rate(study: &Study, rate: usize, more: &[&str]) -> Result<Trace> {
    let rate = format!("firmware.laser_freq={rate}");
    let set: Vec<_> = [rate.as_str()].into_iter().chain(more.iter().copied()).collect();
    let (_, seen) = captured_by(study, SCOPE, &set)?;
    Ok(Trace::of_capture(&seen, 0..seen.samples(), LASER_NS))
}

/// The value that all have, or NaN.
fn common(all: impl IntoIterator<Item = f64>) -> f64 {
    let mut all = all.into_iter();
    let first = all.next().unwrap_or(f64::NAN);
    if all.all(|one| one == first) { first } else { f64::NAN }
}

pub(super) fn rates(study: &Study) -> Result<Measured> {
    let mut all = Trace { step_ns: LASER_NS, ..Trace::default() };
    let mut values = Values::default();
    for (rate, mhz) in RATES_MHZ.into_iter().enumerate() {
        let one = at_rate(study, rate, &[])?;
        let rises = one.rises_ns("laser_pulse");
        let period_ns = common(rises.windows(2).map(|pair| pair[1] - pair[0]));
        values.put(format!("period_ns.{mhz}"), period_ns);
        let first = rises.first().copied().unwrap_or(0.0) / LASER_NS;
        let mut wave = one.waves[0].clone();
        wave.samples = wave.samples.into_iter().skip(first as usize).take(DRAWN).collect();
        wave.name = format!("{mhz} MHz");
        all.waves.push(wave);
    }
    Ok(Measured::from(values).trace(all))
}

pub(super) fn modes(study: &Study) -> Result<Measured> {
    let trace = at_rate(study, 3, &["firmware.mode=0"])?;
    let (resets, pulses) = (trace.rises_ns("spad_rst"), trace.rises_ns("laser_pulse"));
    // The laser edge ends the `clk_laser` cycle in which `laser_pulse` is high.
    let lead = |edge: f64| {
        let before = resets.iter().rev().find(|reset| **reset < edge);
        before.map_or(f64::NAN, |reset| edge - reset)
    };
    let free = at_rate(study, 3, &["firmware.mode=1"])?;
    let mut values = Values::default();
    values.put("lead_ns", common(pulses.iter().skip(1).map(|pulse| lead(pulse + LASER_NS))));
    values.put("free_resets", free.high("spad_rst") as f64);
    values.put("free_samples", free.samples() as f64);
    Ok(values.into())
}

pub(super) fn trigger(study: &Study) -> Result<Measured> {
    let (_, seen) = captured(study, "fig_6_6", &[])?;
    let whole = Trace::of_capture(&seen, 0..seen.samples(), LASER_NS);
    let (resets, pulses) = (whole.rises_ns("SPAD_RST_DO"), whole.rises_ns("VCSEL_ON"));
    let is_reset =
        |pulse: &f64| resets.iter().any(|reset| (pulse - 2.0 * LASER_NS..=*pulse).contains(reset));
    let mut values = Values::default();
    values.put("pulses", pulses.len() as f64);
    let all_are_reset = pulses.len() > 1 && pulses.iter().skip(1).all(is_reset);
    values.put("each_is_reset", f64::from(all_are_reset));
    let middle = seen.triggers.first().copied().unwrap_or(0);
    let from = middle.saturating_sub(8);
    Ok(Measured::from(values).trace(Trace::of_capture(&seen, from..from + 64, LASER_NS)))
}
