//! Steps a block alone, and keeps what goes in and what comes out.

use tofsim::firmware::tof_top::{Pins, TofTop};
use tofsim::hierarchy::{self, Entry};
use tofsim::kernel::signals::{Signal, Signals};

use super::cover::Cover;
use super::draw::Draw;
use super::lines::Lines;
use super::setting::Setting;
use super::spec::{Spec, Vectors};

/// A block under way.
pub struct Recorder<'a> {
    /// The block, inside an otherwise idle top.
    pub top: TofTop,
    /// Draws for its stimulus.
    pub draw: Draw,
    lines: Lines<'a>,
}

impl<'a> Recorder<'a> {
    /// The block before the first edge. A line of the stimulus has `inputs`: its input ports, or what
    /// the bench makes them from.
    pub fn new(spec: &'static Spec, setting: &'a Setting, inputs: Vec<Signal>) -> Self {
        Self::with(spec, setting, inputs, |_| true)
    }

    /// Begins as [`Recorder::new`] does, without the signals inside the block's parts, which have benches of
    /// their own: where there is so much of it that a simulator reads the lines for longer than it takes to
    /// simulate them.
    pub fn without_parts(spec: &'static Spec, setting: &'a Setting, inputs: Vec<Signal>) -> Self {
        Self::with(spec, setting, inputs, |entry| entry.scope == spec.path())
    }

    fn with(
        spec: &'static Spec,
        setting: &'a Setting,
        inputs: Vec<Signal>,
        wanted: impl Fn(&Entry) -> bool,
    ) -> Self {
        let entries = hierarchy::every_entry_of(&setting.setup.params.sizes());
        Recorder {
            top: TofTop::new(Pins::default(), &setting.setup.params),
            draw: Draw::new(setting.seed, spec.stream()),
            lines: Lines::new(spec, setting, inputs, &entries, wanted),
        }
    }

    /// The input of the edge that ends the cycle, and the cycle's first sample.
    pub fn line(&mut self, i: &impl Signals) {
        self.lines.input(i);
        self.sample();
    }

    /// The next sample that the bench takes of the cycle.
    pub fn sample(&mut self) {
        let top = &self.top;
        self.lines.sample(|sink| hierarchy::changes(top, None, sink));
    }

    /// Returns what has been recorded, with its coverage.
    pub fn vectors(self, coverage: impl Into<Vec<Cover>>) -> Vectors {
        Vectors { coverage: coverage.into(), ..self.lines.vectors() }
    }
}
