//! Every change of rate at every phase, acquisition and laser switched on and off, both resets, each in
//! the last cycles before a laser edge too.

use tofsim::firmware::vcsel_driver::{In, PERIODS};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::BOTH,
    reset: Some("rst"),
    fast: &["laser_on", "fire_last", "pulse_0", "pulse_1", "laser_pulse", "ddr_output.q"],
    latency: &[Latency { from: "acquire", to: "start", cycles: |_| 5 }],
    ..Spec::new("vcsel_driver", "vcsel_driver", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let phases = PERIODS.iter().zip(0..);
    let phases = phases.flat_map(|(&period, rate)| (0..period).map(move |n| rate * 32 + n));
    let mut phases = Cover::new("laser_freq changes, rate x 32 + count", phases);
    let mut changes = Cover::new("laser_freq from x 4 + to, taken at a wrap", 0..16);
    // Cycles to the laser edge x 8, and what comes.
    let mut ends = Cover::new(
        "cycles to the laser edge x 8 + rst, rst_laser, acquire low as bits, one of them",
        (0..4).flat_map(|left| [1, 2, 4].map(|what| left * 8 + what)),
    );
    let mut run = Recorder::new(spec, setting, In::list());
    let mut i =
        In { rst: true, rst_laser: true, acquire: true, laser_en: true, laser_freq: U::new(3) };
    for cycle in 0..setting.cycles() {
        let before = i.laser_freq;
        if run.draw.one_in(12) {
            i.laser_freq = run.draw.word();
        }
        i.laser_en ^= run.draw.one_in(40);
        i.acquire = if i.acquire { !run.draw.one_in(100) } else { run.draw.one_in(5) };
        (i.rst, i.rst_laser) = (run.draw.one_in(200), run.draw.one_in(200));
        if cycle == FIRST_RESET {
            (i.rst, i.rst_laser) = (true, true);
        }
        if let Some((rate, count, wraps)) = run.top.vcsel_driver.registers.place() {
            changes.see_if(wraps && i.acquire, rate * 4 + i.laser_freq.get());
            phases.see_if(before != i.laser_freq, rate * 32 + count);
            let left = PERIODS[rate as usize] - 1 - count;
            ends.see(left * 8 + bits([i.rst, i.rst_laser, !i.acquire]));
        }
        run.line(&i);
        run.top.vcsel_driver.fall_laser();
        run.sample();
        if cycle > 0 {
            run.top.vcsel_driver.rise_laser(&i);
        }
        run.sample();
        run.top.vcsel_driver.fall_laser();
        run.sample();
        run.top.vcsel_driver.rise(&i);
    }
    Ok(run.vectors([changes, phases, ends]))
}
