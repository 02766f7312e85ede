//! Pulses of one half cycle, alone and in rows.

use tofsim::firmware::ddr_output::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::CLK_LASER,
    fast: &["q"],
    latency: &[Latency { from: "d", to: "q", cycles: |_| 0 }],
    ..Spec::new("ddr_output", "vcsel_driver.ddr_output", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut levels = Cover::new("d in three cycles, as bits", 0..8);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut last = 0;
    for cycle in 0..setting.cycles() {
        let d = run.draw.one_in(2);
        last = last * 2 % 8 + u64::from(d);
        levels.see_if(cycle >= 2, last);
        run.line(&In { d });
        let output = run.top.vcsel_driver.ddr_output.fall();
        run.top.vcsel_driver.ddr_output = output;
        run.sample();
        run.top.vcsel_driver.ddr_output = output.rise(&In { d });
    }
    Ok(Vectors { settles: 1, ..run.vectors([levels]) })
}
