//! A ROM of 37 random codes, read past its end and cut short by a reset at every word; shots back to
//! back and apart.

use tofsim::firmware::code_preload::In;

use crate::golden::prelude::*;

/// Words of the ROM: no power of two.
const CODES: u64 = 37;
/// Shots of a run that begins the ROM a third time.
const LONG: u64 = 2 * CODES + 10;

pub(super) const SPEC: Spec = Spec {
    stream: Some(2),
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "tdc_valid", cycles: |_| 1 }],
    ..Spec::new("code_preload", "code_preload", record::<CodePreload>)
};

struct CodePreload {
    rom: Vec<U<8>>,
    /// Shots since the last reset.
    shots: u64,
    /// Shots before the next one.
    until: u64,
    /// `start` in the last two cycles, as bits.
    starts: u64,
    words: Cover,
    resets: Cover,
    phases: Cover,
}

impl Block for CodePreload {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        CodePreload {
            rom: (0..CODES).map(|_| U::new(draw.below(setting.bins))).collect(),
            shots: 0,
            until: LONG,
            starts: 0,
            words: Cover::new("shots since the reset", 0..LONG),
            resets: Cover::new("reset after shots", 0..CODES),
            phases: Cover::new("rst x 8 + start in three cycles, as bits", 0..16),
        }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let rst = self.shots == self.until && draw.one_in(3);
        let start = (rst || self.shots < self.until) && draw.one_in(2);
        self.starts = self.starts * 2 % 8 + u64::from(start);
        self.phases.see(u64::from(rst) * 8 + self.starts);
        self.words.see(self.shots);
        self.resets.see_if(rst, self.shots);
        self.shots += u64::from(start);
        if rst {
            self.shots = 0;
            self.until = match self.until + 1 {
                CODES => LONG,
                next if next > LONG => 0,
                next => next,
            };
        }
        In { rst, start }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.code_preload = top.code_preload.next(i, &self.rom);
    }

    fn parameters(&self) -> Parameters {
        let codes = Parameter::Memory(roms::codes(&self.rom));
        vec![("Codes", Parameter::Number(CODES)), ("CodeFile", codes)]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.words, self.resets, self.phases]
    }
}
