//! The logic analyser's core: a ring buffer behind a trigger.

use super::capture::{Capture, Probe};
use super::storing::{Shape, Storing};

/// Stores samples of so many words.
#[derive(Clone, Debug)]
pub struct Core {
    storing: Storing,
    /// Words of a row.
    stride: usize,
    /// The stored rows, one after the other.
    words: Vec<u64>,
    /// Number of the next sample.
    number: u64,
    /// Number of the sample that triggered each window.
    triggers: Vec<u64>,
}

impl Core {
    /// An empty buffer for rows of `stride` words.
    pub fn new(shape: Shape, stride: usize) -> Self {
        let (storing, words) = (Storing::new(shape), Vec::new());
        Core { storing, stride, words, number: 0, triggers: Vec::new() }
    }

    /// Takes a sample: its row, whether the trigger holds, and whether it may be stored.
    #[inline]
    pub fn sample(&mut self, row: &[u64], triggers: bool, qualifies: bool) {
        if let Some(stored) = self.storing.sample(triggers, qualifies) {
            let begin = stored.slot * self.stride;
            match self.words.get_mut(begin..begin + self.stride) {
                Some(words) => words.copy_from_slice(row),
                None => self.words.extend_from_slice(row),
            }
            if stored.triggered {
                self.triggers.push(self.number);
            }
        }
        self.number += 1;
    }

    /// Whether all windows have their samples.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.storing.is_full()
    }

    /// Whether a trigger, now or later, can still matter.
    #[inline]
    pub fn looks_for_triggers(&self) -> bool {
        self.storing.looks_for_triggers()
    }

    /// Numbers of the samples that triggered, counted from 0.
    pub fn triggers(&self) -> &[u64] {
        &self.triggers
    }

    /// Samples taken so far, stored or not.
    pub fn taken(&self) -> u64 {
        self.number
    }

    /// What the buffer holds: the full windows and, stopped early, a last one that is not.
    pub fn finish(self, probes: Vec<Probe>) -> Capture {
        let windows = self.storing.windows();
        let Core { stride, mut words, .. } = self;
        let (mut begins, mut triggers, mut samples) = (Vec::new(), Vec::new(), 0);
        for window in &windows {
            let ring = window.begin * stride..(window.begin + window.before) * stride;
            words[ring].rotate_left(window.turn * stride);
            begins.push(samples);
            if window.after > 0 {
                triggers.push(samples + window.before);
            }
            samples += window.before + window.after;
        }
        words.truncate(samples * stride);
        Capture { stride, words, windows: begins, triggers, ..Capture::new(probes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples that trigger where there is a `t`, and do not qualify where the letter is `-` or
    /// `T`; the row is the sample's number.
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
