//! Every address of a random histogram, in order and at random.

use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::histogram_preload::{self, In, Rom};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(11),
    timing: timing::NONE,
    ..Spec::new("histogram_preload", "histogram_preload", record::<HistogramPreload>)
};

struct HistogramPreload {
    rom: Rom,
    bins: u64,
    words: Cover,
}

impl Block for HistogramPreload {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let mut rom = [U::new(0); BINS];
        rom[..setting.bins as usize].fill_with(|| draw.word());
        let words = Cover::new("words read", 0..setting.bins);
        HistogramPreload { rom, bins: setting.bins, words }
    }

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> In {
        let word = match cycle as u64 / self.bins % 2 {
            0 => cycle as u64 % self.bins,
            _ => draw.below(self.bins),
        };
        self.words.see(word);
        In { read_addr: U::new(word) }
    }

    fn settle(&mut self, i: &In, top: &mut TofTop) {
        top.nets.count = histogram_preload::count(i, &self.rom);
    }

    fn parameters(&self) -> Parameters {
        files(["HistogramFile"], [roms::histogram(&self.rom)])
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.words]
    }
}
