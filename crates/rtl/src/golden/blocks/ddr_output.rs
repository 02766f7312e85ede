//! Pulses of one half cycle, alone and in rows; with a host, blocked and switched off too.

use tofsim::firmware::ddr_output::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::CLK_LASER,
    fast: &["q"],
    latency: &[Latency { from: "d", to: "q", cycles: |_| 0 }],
    configurations: &[
        Configuration { parameters: &["Halves"], ..LONG_PULSE },
        HOSTED,
        Configuration { parameters: &["Halves", "Hosted"], ..HOSTED_LONG_PULSE },
    ],
    model: Some(Model {
        settle: |at| {
            let (i, output) = (at.input(), &mut at.top.vcsel_driver.ddr_output);
            *output = output.settled(&i);
        },
        ..Model::new::<In>(|at| {
            let (i, output) = (at.input(), &mut at.top.vcsel_driver.ddr_output);
            *output = if at.edge == Edge::Fall { output.fall() } else { output.rise(&i) };
        })
    }),
    ..Spec::new("ddr_output", "vcsel_driver.ddr_output", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let halves = setting.setup.params.sizes().pulse_half_cycles.min(2);
    let values = 1 << halves;
    let mut levels = Cover::new("d in three cycles, side by side", 0..values * values * values);
    let is_hosted = setting.setup.params.is_hosted;
    let mut blocks = Cover::new("levels that do not pass", 0..if is_hosted { values } else { 1 });
    let mut offs = Cover::new("off from x 2 + to", 0..if is_hosted { 4 } else { 1 });
    let mut run = Recorder::new(spec, setting, In::list());
    let (mut last, mut off) = (0, false);
    for cycle in 0..setting.cycles() {
        let d = values - 1 - run.draw.below(values);
        last = (last * values + d) % (values * values * values);
        let was_off = off;
        off = is_hosted && off ^ run.draw.one_in(5);
        let block = if is_hosted { run.draw.below(values) } else { 0 };
        let i = In { d: U::new(d), off, block: U::new(block) };
        levels.see_if(cycle >= 2, last);
        blocks.see(block);
        offs.see(bits([was_off, off]));
        let output = run.top.vcsel_driver.ddr_output.settled(&i);
        run.top.vcsel_driver.ddr_output = output;
        run.line(&i);
        let output = run.top.vcsel_driver.ddr_output.fall();
        run.top.vcsel_driver.ddr_output = output;
        run.sample();
        run.top.vcsel_driver.ddr_output = output.rise(&i);
    }
    Ok(Vectors { settles: 1, ..run.vectors([levels, blocks, offs]) })
}
