//! A frame simulated cycle by cycle: prints the first ten TDC codes, and the cycles in which the estimator starts and
//! finishes.

use std::ops::ControlFlow;

use tofsim::{Run, Setup};

/// As a waveform names them; `tof_top.` may be left out.
const SIGNALS: [&str; 5] = ["tdc_valid", "tdc_code", "algo_start", "algo_done", "depth"];

fn main() -> tofsim::Result<()> {
    let setup = Setup::load("kc705", &["firmware.shots_per_frame=1000"])?;
    let mut codes = 0;
    let outcome = Run::new(&setup).step_cycles(
        1,
        SIGNALS,
        |cycle, [tdc_valid, tdc_code, algo_start, algo_done, depth]| {
            let (number, begin) = (cycle.number, cycle.begin);
            if tdc_valid == 1 && codes < 10 {
                codes += 1;
                println!("cycle {number} at {begin}: code {tdc_code}");
            }
            if algo_start == 1 {
                println!("cycle {number} at {begin}: the estimator begins");
            }
            if algo_done == 1 {
                let depth_m = depth as f64 / f64::from(1 << 29);
                println!("cycle {number} at {begin}: {depth_m:.4} m");
            }
            Ok(ControlFlow::Continue(()))
        },
    )?;
    println!("{} cycles, {} shots", outcome.cycles, outcome.shots);
    Ok(())
}
