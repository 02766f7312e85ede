//! Laser, SPAD control and TDC: Tables 6.1 to 6.3, Fig. 6.3, 6.6 and 6.9.

use tofsim::error::Result;

use crate::page::trace::Trace;
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

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
    let (_, seen) = study.captured_by(SCOPE, &set)?;
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
    let (_, seen) = study.captured("fig_6_6", &[])?;
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

/// Period of `clk_sys` [ns].
const CYCLE_NS: f64 = 8.0;
/// Stops of Table 6.3 after start, in the order of the scenario's shots [ns].
const STOPS_NS: [&str; 3] = ["2", "4", "8"];

/// The clock, start, stop and count, as an analyser at 1 GHz sees them.
const TDC_SCOPE: &str = "scenario = \"tdc_validation\"\nclock = \"1000MHz\"\ndepth = 1024\nposition = 40\n\
    trigger = \"start rising\"\n\
    [[probe]]\nname = \"clk_125\"\nsignal = \"pll.clk_sys\"\n\
    [[probe]]\nname = \"start\"\nsignal = \"start\"\n\
    [[probe]]\nname = \"tdc_stop\"\nsignal = \"tdc_stop\"\n\
    [[probe]]\nname = \"hit\"\nsignal = \"tdc.tdc_latch.hit\"\n\
    [[probe]]\nname = \"n\"\nsignal = \"tdc.tdc_decoder.n\"\nradix = \"unsigned\"\n";
/// Step of its samples [ns].
const STEP_NS: f64 = 1.0;

pub(super) fn timing(study: &Study) -> Result<Measured> {
    let (_, seen) = study.captured_by(TDC_SCOPE, &[])?;
    let mut trace = Trace::of_capture(&seen, 32..100, STEP_NS);
    let start = trace.rises_ns("start").first().copied().unwrap_or(f64::NAN);
    let stop = trace.rises_ns("tdc_stop").first().copied().unwrap_or(f64::NAN);
    let clocks = trace.rises_ns("clk_125");
    let after = clocks.iter().copied().find(|edge| *edge > stop).unwrap_or(f64::NAN);
    let span = |name: &str, from: f64, to: f64| (from..to, format!("{name} = {} ns", to - from));
    trace.spans = vec![span("T1", start, after), span("T2", start, stop), span("T3", stop, after)];
    let mut values = Values::default();
    values.put("start", start);
    values.put("stop", stop);
    values.put("after", after);
    values.put("start_is_an_edge", f64::from(clocks.contains(&start)));
    Ok(Measured::from(values).trace(trace))
}

pub(super) fn delay_cells(study: &Study) -> Result<Measured> {
    let setup = study.setup("tdc_validation", &[])?;
    let mut values = Values::default();
    let mut found = Vec::new();
    for (shot, stop) in study.shots(&setup)?.iter().zip(STOPS_NS) {
        let t2 = shot.arrival_fs.map_or(f64::NAN, |fs| fs as f64 * 1e-6);
        let t1 = shot.coarse.map_or(f64::NAN, |coarse| CYCLE_NS * (coarse + 1) as f64);
        let n = shot.n.map_or(f64::NAN, |n| n as f64);
        values.put(format!("n.{stop}"), n);
        values.put(format!("t1.{stop}"), t1);
        values.put(format!("t2.{stop}"), t2);
        found.push((stop, t1 - t2, n));
    }
    for (one, one_t3, one_n) in &found {
        for (other, other_t3, other_n) in &found {
            let lsb_ps = 1e3 * (one_t3 - other_t3) / (one_n - other_n);
            values.put(format!("lsb_ps.{one}.{other}"), lsb_ps);
        }
    }
    Ok(values.into())
}
