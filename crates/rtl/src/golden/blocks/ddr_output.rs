//! Pulses of one half cycle, alone and in rows.

use tofsim::firmware::ddr_output::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::CLK_LASER,
    fast: &["q"],
    latency: &[Latency { from: "d", to: "q", cycles: |_| 0 }],
    configurations: &[Configuration { parameters: &["Halves"], ..LONG_PULSE }],
    model: Some(Model::new::<In>(|at| {
        let (i, output) = (at.input(), &mut at.top.vcsel_driver.ddr_output);
        *output = if at.edge == Edge::Fall { output.fall() } else { output.rise(&i) };
    })),
    ..Spec::new("ddr_output", "vcsel_driver.ddr_output", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let halves = setting.setup.params.sizes().pulse_half_cycles.min(2);
    let values = 1 << halves;
    let mut levels = Cover::new("d in three cycles, side by side", 0..values * values * values);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut last = 0;
    for cycle in 0..setting.cycles() {
        let d = values - 1 - run.draw.below(values);
        last = (last * values + d) % (values * values * values);
        let i = In { d: U::new(d) };
        levels.see_if(cycle >= 2, last);
        run.line(&i);
        let output = run.top.vcsel_driver.ddr_output.fall();
        run.top.vcsel_driver.ddr_output = output;
        run.sample();
        run.top.vcsel_driver.ddr_output = output.rise(&i);
    }
    Ok(Vectors { settles: 1, ..run.vectors([levels]) })
}
