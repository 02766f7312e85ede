//! A ROM of 37 random codes, read past its end and cut short by a reset at every word; shots back to
//! back and apart.

use tofsim::firmware::code_preload::In;
use tofsim::firmware::tof_top::CodeSource;

use crate::golden::prelude::*;

/// Words of the ROM: no power of two.
const CODES: u64 = 37;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "tdc_valid", cycles: |_| 1 }],
    model: Some(Model::new::<In>(|at| {
        if let CodeSource::Preload(rom) = &at.params.code_source {
            at.top.code_preload.tick(&at.input(), rom);
        }
    })),
    ..Spec::new("code_preload", "code_preload", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut draw = Draw::new(setting.seed, MEMORIES);
    let rom = match (&setting.setup.params.code_source, setting.constants.has("CodeFile")) {
        (_, false) => (0..CODES).map(|_| U::new(draw.below(setting.bins))).collect(),
        (CodeSource::Preload(rom), true) => rom.to_vec(),
        (CodeSource::Tdc, true) => return Err(setting.lacks("CodeFile", "stimulus.codes")),
    };
    let codes = rom.len() as u64;
    // Shots of a run that begins the ROM a third time; of a long ROM not each word is followed by a
    // reset.
    let long = 2 * codes + 10;
    let stride = codes.div_ceil(2 * CODES);
    let mut words = Cover::new("shots since the reset", 0..long);
    let mut resets = Cover::new("reset after shots", (0..codes).step_by(stride as usize));
    let mut phases = Cover::new("rst x 8 + start in three cycles, as bits", 0..16);
    let lines = 2 * (long + codes * codes.div_ceil(stride) / 2 + 10 * codes);
    let mut run = Recorder::new(spec, setting, In::list());
    // Shots since the last reset and before the next one; `start` in the last two cycles, as bits.
    let (mut shots, mut until, mut starts) = (0, long, 0);
    for cycle in 0..setting.cycles.unwrap_or(Setting::CYCLES.max(lines as usize)) {
        let rst = cycle == FIRST_RESET || shots == until && run.draw.one_in(3);
        let start = (rst || shots < until) && run.draw.one_in(2);
        starts = starts * 2 % 8 + u64::from(start);
        phases.see(u64::from(rst) * 8 + starts);
        words.see(shots);
        resets.see_if(rst, shots);
        shots += u64::from(start);
        if rst {
            shots = 0;
            until = match until + stride {
                next if next > long => 0,
                next if next >= codes => long,
                next => next,
            };
        }
        let i = In { rst, start };
        run.line(&i);
        run.top.code_preload = run.top.code_preload.next(&i, &rom);
    }
    let file = Parameter::Memory(parameters::codes(&rom, &setting.histogram()));
    let own = vec![("Codes", Parameter::Number(codes)), ("CodeFile", file)];
    Ok(run.vectors([words, resets, phases]).with(own))
}
