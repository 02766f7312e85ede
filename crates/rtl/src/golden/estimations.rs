//! Estimations one after the other, as the stimuli of both estimators begin them and cut them short.

use std::ops::Range;

use tofsim::firmware::histogram_builder::{Count, Params};
use tofsim::network::mem::{Mem, digits, lines};

use super::cover::Cover;
use super::draw::Draw;
use super::setting::Setting;
use super::spec::FIRST_RESET;

/// Words of a histogram [hits].
pub type Histogram = Vec<Count>;

/// Most hits of a histogram that is drawn hit by hit, and what each of them counts: a wider word is filled
/// with as many draws.
pub fn draws(size: &Params) -> (u64, u64) {
    let each = 1 << size.count_bits.saturating_sub(16);
    (size.most_hits() / each, each)
}

/// The memory from which the bench reads histograms, one after the other.
pub fn memory(histograms: &[Histogram], size: &Params) -> Mem {
    let words = histograms.iter().flatten().map(|count| count.get());
    Mem::new("histograms.mem", lines(words, digits(size.count_bits)))
}

/// Parts of an estimation.
const PARTS: usize = 4;
/// One of so many estimations is cut short.
const CUT: u64 = 6;

/// Sequence of estimations: which histogram is there, the control signals of each cycle, and the coverage.
pub struct Estimations {
    /// The histogram that is there.
    pub histogram: u64,
    /// Histograms in all.
    count: u64,
    /// Cycles of each part, after the edge that takes `algo_start`; `algo_done` comes at the end.
    parts: [Range<u64>; PARTS],
    /// Estimations begun.
    begun: u64,
    /// Cycle in which this one is cut short.
    cut: Option<u64>,
    /// Cycles for which a slower estimator is left alone after an estimation, and those still to come.
    slack: u64,
    rest: u64,
    /// Cycles before the end of an estimation in which a faster estimator has ended its own.
    lead: u64,
    line: usize,
    done: Cover,
    starts: Cover,
    resets: Cover,
}

impl Estimations {
    /// Of `count` histograms, of which the first `special` ones have to be estimated.
    pub fn new(parts: [Range<u64>; PARTS], count: usize, special: u64, setting: &Setting) -> Self {
        Estimations {
            histogram: 0,
            count: count as u64,
            parts,
            begun: 0,
            cut: None,
            slack: setting.slack,
            rest: 0,
            lead: setting.lead,
            line: 0,
            done: Cover::new("estimations of histogram", 0..special),
            starts: Cover::new("start in part, with algo_done (4), idle (5)", 0..6),
            resets: Cover::new("reset in part, with algo_done (4)", 0..=PARTS as u64),
        }
    }

    /// `rst` and `algo_start` of a cycle; `phase` is how far the estimator is, if it is busy.
    pub fn next(&mut self, phase: Option<u64>, draw: &mut Draw) -> (bool, bool) {
        let end = self.parts[PARTS - 1].end;
        let rst = self.line == FIRST_RESET || phase.is_some() && phase == self.cut;
        self.line += 1;
        self.rest = if phase.is_some() { self.slack } else { self.rest.saturating_sub(1) };
        let has_led = phase.is_some_and(|phase| phase < end && phase + self.lead >= end);
        let algo_start = draw.one_in(3) && self.rest == 0 && !has_led;
        let part = match phase {
            Some(phase) => self.parts.iter().take_while(|part| part.end <= phase).count(),
            None => PARTS + 1,
        };
        self.starts.see_if(algo_start && !rst, part as u64);
        self.resets.see_if(rst, part as u64);
        self.done.see_if(phase == Some(end), self.histogram);
        if algo_start && !rst && phase.is_none_or(|phase| phase == end) {
            self.begin(draw);
        }
        (rst, algo_start)
    }

    /// Another histogram, and perhaps a cycle in which its estimation is cut short.
    fn begin(&mut self, draw: &mut Draw) {
        let next = self.done.missing().next();
        self.histogram = next.unwrap_or_else(|| draw.below(self.count));
        self.begun += 1;
        let places = self.parts.clone().map(|part| match part.end - part.start {
            1 => part.start,
            cycles => part.start + draw.below(cycles),
        });
        // A reset that comes with the result stops a slower estimator, but not the result that is compared with.
        let cuts = if self.slack == 0 { PARTS + 1 } else { PARTS };
        let cut = (self.begun / CUT) as usize % cuts;
        let place = places.get(cut).copied().unwrap_or(self.parts[PARTS - 1].end);
        self.cut = self.begun.is_multiple_of(CUT).then_some(place);
    }

    /// Returns the coverage.
    pub fn coverage(self) -> [Cover; 3] {
        [self.done, self.starts, self.resets]
    }
}
