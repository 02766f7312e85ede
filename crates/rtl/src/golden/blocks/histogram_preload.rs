//! Every address of a random histogram, in order and at random.

use crate::golden::block::{Block, Parameter, Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::{Draw, MEMORIES};
use crate::golden::record::record;
use crate::golden::roms;
use crate::golden::timing::NONE;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::histogram_preload::{self, In, Rom};
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::U;
use tofsim::network::mem::Mem;

pub(super) const SPEC: Spec = Spec {
    name: "histogram_preload",
    scope: "histogram_preload",
    stream: Some(11),
    timing: NONE,
    reset: None,
    fast: &[],
    latency: &[],
    glue: None,
    record: |spec, setting| record(spec, setting, HistogramPreload::new(setting)),
};

struct HistogramPreload {
    rom: Rom,
    bins: u64,
    words: Cover,
}

impl HistogramPreload {
    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let mut rom = [U::new(0); BINS];
        rom[..setting.bins as usize].fill_with(|| draw.word());
        let words = Cover::new("words read", 0..setting.bins);
        HistogramPreload { rom, bins: setting.bins, words }
    }
}

impl Block for HistogramPreload {
    type Stimulus = In;

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

    fn edge(&mut self, _: &In, _: &mut TofTop) {}

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("HistogramFile", Parameter::File("histogram.mem"))]
    }

    fn roms(&self) -> Vec<Mem> {
        vec![roms::histogram(&self.rom)]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.words]
    }
}
