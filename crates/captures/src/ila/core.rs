//! The logic analyser's core: a ring buffer with a trigger.

use super::capture::{Capture, Probe};

/// Dimensions of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Samples per window, at least 1.
    pub depth: usize,
    /// Number of windows, at least 1.
    pub windows: usize,
    /// Samples of a window before the trigger, less than `depth`.
    pub position: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Stores the samples before the trigger; triggers are ignored.
    Filling,
    /// Waits for a trigger.
    Waiting,
    /// Stores the samples after the trigger.
    Triggered,
    /// All windows are complete.
    Full,
}

/// Ring buffer with trigger.
///
/// A window first stores `position` samples, then waits for a trigger while it keeps the last `position` samples, and
/// then stores until it has `depth` samples; the next window begins with the very next sample. Only qualified samples
/// and the triggering sample are stored.
#[derive(Clone, Debug)]
pub struct Core {
    shape: Shape,
    /// Words per sample.
    stride: usize,
    /// Words of the stored samples.
    words: Vec<u64>,
    state: Phase,
    /// Number of samples stored in the present window before its trigger.
    before: usize,
    /// Ring index of the next sample before the trigger.
    next: usize,
    /// Number of samples stored from the trigger on.
    after: usize,
    /// For each complete window, the ring index of its oldest sample.
    full: Vec<usize>,
    /// Number of the next sample.
    number: u64,
    /// Number of the sample that triggered each window.
    triggers: Vec<u64>,
}

impl Core {
    /// Creates an empty buffer for samples of `stride` words.
    pub fn new(shape: Shape, stride: usize) -> Self {
        let mut core = Core {
            shape,
            stride,
            words: Vec::new(),
            state: Phase::Waiting,
            before: 0,
            next: 0,
            after: 0,
            full: Vec::new(),
            number: 0,
            triggers: Vec::new(),
        };
        core.begin();
        core
    }

    fn begin(&mut self) {
        (self.before, self.next, self.after) = (0, 0, 0);
        self.state = match self.shape.position {
            _ if self.full.len() == self.shape.windows => Phase::Full,
            0 => Phase::Waiting,
            _ => Phase::Filling,
        };
    }

    /// Processes a sample, given whether it satisfies the trigger and the storage qualifier.
    #[inline]
    pub fn sample(&mut self, row: &[u64], triggers: bool, qualifies: bool) {
        let slot = match self.state {
            Phase::Waiting if triggers => {
                self.triggers.push(self.number);
                Some(self.follow())
            }
            Phase::Triggered if qualifies => Some(self.follow()),
            Phase::Filling | Phase::Waiting if qualifies && self.shape.position > 0 => {
                Some(self.lead())
            }
            _ => None,
        };
        if let Some(slot) = slot {
            let begin = slot * self.stride;
            match self.words.get_mut(begin..begin + self.stride) {
                Some(words) => words.copy_from_slice(row),
                None => self.words.extend_from_slice(row),
            }
        }
        self.number += 1;
    }

    /// Returns the index at which to store a sample before the trigger: the next free one, or that of the oldest
    /// sample.
    #[inline]
    fn lead(&mut self) -> usize {
        let slot = self.full.len() * self.shape.depth + self.next;
        self.next = if self.next + 1 == self.shape.position { 0 } else { self.next + 1 };
        if self.state == Phase::Filling {
            self.before += 1;
            if self.before == self.shape.position {
                self.state = Phase::Waiting;
            }
        }
        slot
    }

    /// Returns the index at which to store the triggering sample or one after it.
    #[inline]
    fn follow(&mut self) -> usize {
        let Shape { depth, position, .. } = self.shape;
        let slot = self.full.len() * depth + position + self.after;
        self.state = Phase::Triggered;
        self.after += 1;
        if position + self.after == depth {
            self.full.push(self.next);
            self.begin();
        }
        slot
    }

    /// Returns whether all windows are complete.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.state == Phase::Full
    }

    /// Returns whether the present window still lacks samples before its trigger, so that triggers are ignored.
    #[inline]
    pub fn is_filling(&self) -> bool {
        self.state == Phase::Filling
    }

    /// Returns whether the present or a later window still needs a trigger.
    #[inline]
    pub fn looks_for_triggers(&self) -> bool {
        self.triggers.len() < self.shape.windows
    }

    /// Returns the numbers of the samples that triggered, counted from 0.
    pub fn triggers(&self) -> &[u64] {
        &self.triggers
    }

    /// Returns the number of samples processed, stored or not.
    pub fn taken(&self) -> u64 {
        self.number
    }

    /// Returns the buffer's contents: the complete windows, followed by the present one if it has a sample. A window
    /// without trigger contains the samples stored for before its trigger.
    pub fn finish(self, probes: Vec<Probe>) -> Capture {
        let Core { stride, mut words, .. } = self;
        let Shape { depth, position, .. } = self.shape;
        let full = self.full.iter().map(|&turn| (position, turn, depth - position));
        let turn = if self.state == Phase::Filling { 0 } else { self.next };
        let partial = (self.before + self.after > 0).then_some((self.before, turn, self.after));
        let (mut windows, mut triggers, mut samples) = (Vec::new(), Vec::new(), 0);
        for (before, turn, after) in full.chain(partial) {
            words[samples * stride..(samples + before) * stride].rotate_left(turn * stride);
            windows.push(samples);
            if after > 0 {
                triggers.push(samples + before);
            }
            samples += before + after;
        }
        words.truncate(samples * stride);
        Capture { stride, words, windows, triggers, ..Capture::new(probes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Captures a sequence of samples given as letters: `t` or `T` triggers, and `-` or `T` does not qualify. A
    /// sample's value is its number.
    fn capture(depth: usize, windows: usize, position: usize, samples: &str) -> Capture {
        let mut core = Core::new(Shape { depth, windows, position }, 1);
        for (number, sample) in samples.chars().enumerate() {
            core.sample(&[number as u64], "tT".contains(sample), !"-T".contains(sample));
        }
        let triggers = core.triggers().to_vec();
        let capture = core.finish(Vec::new());
        let triggered: Vec<_> = capture.triggers.iter().map(|&at| capture.words[at]).collect();
        assert_eq!(triggered, triggers);
        capture
    }

    #[test]
    fn a_window_stands_around_its_trigger() {
        let capture = capture(4, 1, 2, "......t......");
        assert_eq!(capture.words, [4, 5, 6, 7]);
        assert_eq!((capture.windows, capture.triggers), (vec![0], vec![2]));
    }

    #[test]
    fn a_trigger_while_the_window_fills_is_ignored() {
        assert_eq!(capture(4, 1, 2, "tt.t...").words, [1, 2, 3, 4]);
        assert_eq!(capture(4, 1, 2, "..t....").words, [0, 1, 2, 3]);
    }

    #[test]
    fn windows_without_samples_before_the_trigger_follow_at_once() {
        let capture = capture(2, 3, 0, ".tttttttt");
        assert_eq!(capture.words, [1, 2, 3, 4, 5, 6]);
        assert_eq!((capture.windows, capture.triggers), (vec![0, 2, 4], vec![0, 2, 4]));
        assert_eq!(super::tests::capture(1, 3, 0, "t.tt").words, [0, 2, 3]);
    }

    #[test]
    fn each_window_fills_again_before_its_trigger() {
        let capture = capture(3, 2, 2, "...ttttttt");
        assert_eq!(capture.words, [1, 2, 3, 4, 5, 6]);
        assert_eq!((capture.windows, capture.triggers), (vec![0, 3], vec![2, 5]));
    }

    #[test]
    fn only_qualified_samples_are_stored_and_the_one_that_triggers() {
        assert_eq!(capture(5, 1, 2, ".-.-.-T--.-.").words, [2, 4, 6, 9, 11]);
        assert_eq!(capture(5, 1, 2, "---t.t-t---...").words, [3, 4, 5, 7, 11]);
    }

    #[test]
    fn a_trigger_is_not_looked_for_before_enough_samples_qualify() {
        assert_eq!(capture(3, 1, 2, ".-T-T.T.").words, [0, 5, 6]);
    }

    #[test]
    fn stopped_early_the_last_window_is_not_full() {
        let capture = capture(4, 2, 1, "..t....t.");
        assert_eq!(capture.words, [1, 2, 3, 4, 6, 7, 8]);
        assert_eq!((capture.windows, capture.triggers), (vec![0, 4], vec![1, 5]));
    }

    #[test]
    fn stopped_before_its_trigger_a_window_has_what_stood_before_it() {
        let capture = capture(4, 2, 2, "..t.....");
        assert_eq!(capture.words, [0, 1, 2, 3, 6, 7]);
        assert_eq!((capture.windows, capture.triggers), (vec![0, 4], vec![2]));
        assert_eq!(super::tests::capture(4, 2, 2, "..t......").words, [0, 1, 2, 3, 7, 8]);
        let filling = super::tests::capture(8, 1, 4, "...");
        assert_eq!((filling.words, filling.triggers), (vec![0, 1, 2], vec![]));
        let nothing = super::tests::capture(8, 1, 0, "...");
        assert_eq!((nothing.samples(), nothing.windows), (0, vec![]));
    }

    #[test]
    fn behind_the_last_trigger_no_other_is_looked_for() {
        let mut core = Core::new(Shape { depth: 3, windows: 2, position: 1 }, 1);
        let looks = "..t..t.".chars().map(|sample| {
            core.sample(&[0], sample == 't', true);
            core.looks_for_triggers()
        });
        assert_eq!(looks.collect::<Vec<_>>(), [true, true, true, true, true, false, false]);
    }

    #[test]
    fn a_full_buffer_takes_no_more() {
        let mut core = Core::new(Shape { depth: 2, windows: 1, position: 1 }, 1);
        (0..9).for_each(|number| core.sample(&[number], true, true));
        assert!(core.is_full());
        assert_eq!(core.finish(Vec::new()).words, [0, 1]);
    }
}
