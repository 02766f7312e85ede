//! Every address of a random histogram, in order and at random.

use tofsim::firmware::histogram_preload::{self, In};
use tofsim::firmware::tof_top::HistogramSource;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::NONE,
    model: Some(Model::combinational::<In>(|at| {
        if let HistogramSource::Preload(rom) = &at.params.histogram_source {
            at.top.nets.count = histogram_preload::count(&at.input(), rom);
        }
    })),
    ..Spec::new("histogram_preload", "histogram_preload", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut draw = Draw::new(setting.seed, MEMORIES);
    let (bins, size) = (setting.bins, setting.histogram());
    let mut rom = vec![U::new(0); size.bins];
    rom[..bins as usize].fill_with(|| U::new(draw.bits() & size.most_hits()));
    if setting.constants.has("HistogramFile") {
        let HistogramSource::Preload(words) = &setting.setup.params.histogram_source else {
            return Err(setting.lacks("HistogramFile", "stimulus.histogram"));
        };
        rom.copy_from_slice(&words[..]);
    }
    let mut words = Cover::new("words read", 0..bins);
    let mut run = Recorder::new(spec, setting, In::list());
    for cycle in 0..setting.cycles() as u64 {
        let word = match cycle / bins % 2 {
            0 => cycle % bins,
            _ => run.draw.below(bins),
        };
        words.see(word);
        let i = In { read_addr: U::new(word) };
        run.top.nets.count = histogram_preload::count(&i, &rom);
        run.line(&i);
    }
    let own = files(["HistogramFile"], [parameters::histogram(&rom, &size)]);
    Ok(run.vectors([words]).with(own))
}
