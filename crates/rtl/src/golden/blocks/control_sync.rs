//! Every pair of levels of the five signals one after the other, held for a few cycles or one.

use tofsim::firmware::control_sync::In;
use tofsim::firmware::vcsel_driver::Rate;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    latency: &[
        Latency { from: "mode", to: "mode_sync", cycles: |_| 1 },
        Latency {
            from: "laser_freq",
            to: "laser_freq_sync",
            cycles: |vectors| if vectors.sizes.hosted { 3 } else { 1 },
        },
        Latency { from: "laser_en", to: "laser_en_sync", cycles: |_| 1 },
        Latency { from: "dsp_en", to: "dsp_en_sync", cycles: |_| 1 },
        Latency { from: "dsp_rst", to: "dsp_rst_sync", cycles: |_| 1 },
    ],
    model: Some(Model::new::<In>(|at| {
        at.top.control_sync.tick(&at.input(), &at.params.control_sync());
    })),
    configurations: &[HOSTED],
    ..Spec::new("control_sync", "control_sync", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut pairs = Cover::new("mode, laser_en, dsp_en, dsp_rst as bits, from x 16 + to", 0..256);
    let rate_bits = setting.setup.params.sizes().of(Size::RateBits);
    let codes = 1 << rate_bits;
    let mut rates = Cover::new("laser_freq from x codes + to", 0..codes * codes);
    let mut alone = Cover::new("one signal, 0 to 4, changes alone", 0..5);
    let levels = |i: &In| bits([i.mode, i.laser_en, i.dsp_en, i.dsp_rst]);
    let p = setting.setup.params.control_sync();
    let mut run = Recorder::new(spec, setting, In::list());
    let mut i = In::default();
    for _ in 0..setting.cycles() {
        let before = i;
        let which = run.draw.below(12);
        let mut turn = |level: bool, one: u64| match which {
            5..8 => run.draw.one_in(2),
            _ => level ^ (which == one),
        };
        i.mode = turn(i.mode, 0);
        i.laser_en = turn(i.laser_en, 1);
        i.dsp_en = turn(i.dsp_en, 2);
        i.dsp_rst = turn(i.dsp_rst, 3);
        if (4..8).contains(&which) {
            i.laser_freq = Rate::new(run.draw.bits() % codes);
        }
        pairs.see(levels(&before) * 16 + levels(&i));
        rates.see(before.laser_freq.get() * codes + i.laser_freq.get());
        alone.see_if(before != i, which);
        run.line(&i);
        run.top.control_sync = run.top.control_sync.next(&i, &p);
    }
    Ok(Vectors { settles: if p.is_hosted { 4 } else { 2 }, ..run.vectors([pairs, rates, alone]) })
}
