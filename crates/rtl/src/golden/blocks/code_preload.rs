//! A ROM of 37 random codes, read past its end and cut short by a reset at every word; shots back to
//! back and apart.

use tofsim::firmware::code_preload::In;

use crate::golden::prelude::*;

/// Words of the ROM: no power of two.
const CODES: u64 = 37;
/// Shots of a run that begins the ROM a third time.
const LONG: u64 = 2 * CODES + 10;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "tdc_valid", cycles: |_| 1 }],
    ..Spec::new("code_preload", "code_preload", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut draw = Draw::new(setting.seed, MEMORIES);
    let rom: Vec<U<8>> = (0..CODES).map(|_| U::new(draw.below(setting.bins))).collect();
    let mut words = Cover::new("shots since the reset", 0..LONG);
    let mut resets = Cover::new("reset after shots", 0..CODES);
    let mut phases = Cover::new("rst x 8 + start in three cycles, as bits", 0..16);
    let mut run = Recorder::new(spec, setting, In::list());
    // Shots since the last reset and before the next one; `start` in the last two cycles, as bits.
    let (mut shots, mut until, mut starts) = (0, LONG, 0);
    for _ in 0..setting.cycles() {
        let rst = shots == until && run.draw.one_in(3);
        let start = (rst || shots < until) && run.draw.one_in(2);
        starts = starts * 2 % 8 + u64::from(start);
        phases.see(u64::from(rst) * 8 + starts);
        words.see(shots);
        resets.see_if(rst, shots);
        shots += u64::from(start);
        if rst {
            shots = 0;
            until = match until + 1 {
                CODES => LONG,
                next if next > LONG => 0,
                next => next,
            };
        }
        let i = In { rst, start };
        run.line(&i);
        run.top.code_preload = run.top.code_preload.next(&i, &rom);
    }
    let codes = Parameter::Memory(parameters::codes(&rom));
    let parameters = vec![("Codes", Parameter::Number(CODES)), ("CodeFile", codes)];
    Ok(Vectors { parameters, ..run.vectors([words, resets, phases]) })
}
