//! The TDC: Fig. 6.9 and Table 6.3.

use tofsim::error::Result;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::sim::shot_recorder::Shot;

use crate::page::trace::Trace;
use crate::reproduce::measured::Measured;
use crate::reproduce::scopes::captured_by;
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Period of `clk_sys` [ns].
const CYCLE_NS: f64 = 8.0;
/// Stops of Table 6.3 after start, in the order of the scenario's shots [ns].
const STOPS_NS: [&str; 3] = ["2", "4", "8"];

/// The clock, start, stop and count, as an analyser at 1 GHz sees them.
const SCOPE: &str = "scenario = \"tdc_validation\"\nclock = \"1000MHz\"\ndepth = 1024\nposition = 40\n\
    trigger = \"start rising\"\n\
    [[probe]]\nname = \"clk_125\"\nsignal = \"pll.clk_sys\"\n\
    [[probe]]\nname = \"start\"\nsignal = \"start\"\n\
    [[probe]]\nname = \"tdc_stop\"\nsignal = \"tdc_stop\"\n\
    [[probe]]\nname = \"hit\"\nsignal = \"tdc.tdc_latch.hit\"\n\
    [[probe]]\nname = \"n\"\nsignal = \"tdc.tdc_decoder.n\"\nradix = \"unsigned\"\n";
/// Step of its samples [ns].
const STEP_NS: f64 = 1.0;

pub(super) fn timing(study: &Study) -> Result<Measured> {
    let (_, seen) = captured_by(study, SCOPE, &[])?;
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
    let mut shots: Vec<Shot> = Vec::new();
    let mut take = |shot: &Shot| {
        shots.push(*shot);
        Ok(())
    };
    Run::new(&setup).observe(1, Observers { shots: Some(&mut take), ..Observers::default() })?;
    let mut values = Values::default();
    let mut found = Vec::new();
    for (shot, stop) in shots.iter().zip(STOPS_NS) {
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
