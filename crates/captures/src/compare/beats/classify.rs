//! Classification of differing words: lost, repeated, extra or changed.

use std::ops::Range;

use super::super::result::{BeatDifference, BeatKind, Beats};
use super::stream::{BeatWords, Stream};

/// Two streams and their words.
pub(super) struct Classifier<'a> {
    pub(super) sides: [&'a Stream; 2],
    pub(super) words: &'a BeatWords,
    pub(super) window: usize,
}

impl Classifier<'_> {
    /// Counts the differences between equal words, from `begin` to `end` of both sides.
    pub(super) fn count(
        &self,
        same: &[(usize, usize)],
        begin: [usize; 2],
        end: [usize; 2],
        beats: &mut Beats,
    ) {
        let mut next = begin;
        for &(a, b) in same.iter().chain([&(end[0], end[1])]) {
            self.between([next[0]..a, next[1]..b], beats);
            next = [a + 1, b + 1];
        }
        beats.same += same.len() as u64;
    }

    fn between(&self, [lost, extra]: [Range<usize>; 2], beats: &mut Beats) {
        let [mut a, mut b] = [lost.start, extra.start];
        while a < lost.end || b < extra.end {
            let is_in = [a < lost.end, b < extra.end];
            let kind = match is_in {
                // As many as there are on both sides are other values of the same words.
                [true, true] => BeatKind::Changed,
                [true, false] => BeatKind::Lost,
                _ if self.repeats(b) => BeatKind::Repeated,
                _ => BeatKind::Extra,
            };
            let text = |side: usize, k: usize| {
                let number = self.sides[side].words.get(k).filter(|_| is_in[side])?;
                Some(self.words.text(*number).to_owned())
            };
            beats.push(BeatDifference {
                kind,
                window: self.window,
                beats: [(0, a), (1, b)].map(|(side, k)| self.sides[side].beats.get(k).copied()),
                expected: text(0, a),
                got: text(1, b),
            });
            a += usize::from(is_in[0]);
            b += usize::from(is_in[1]);
        }
    }

    /// Returns whether a word of the second side equals its predecessor or successor.
    fn repeats(&self, k: usize) -> bool {
        let words = &self.sides[1].words;
        let before = k.checked_sub(1).map(|before| words[before]);
        before == Some(words[k]) || words.get(k + 1) == Some(&words[k])
    }
}
