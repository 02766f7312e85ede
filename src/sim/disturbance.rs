//! A delay line that differs from edge to edge: its registers sample too early or too late, and its delays follow the
//! conditions of the die.
//!
//! Without it delays are constant and registers sample at the edge.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::firmware::carry_chain::{Delays, Taps, Transitions};
use crate::kernel::Time;
use crate::kernel::thermometer::CAPACITY;
use crate::scenario::drift::Pace;
use crate::sensor::streams::uniform;

/// The sampling window of the registers, and the pace of the delays.
#[derive(Clone, Debug)]
pub struct Disturbance {
    /// Half of the window about an edge within which a register samples, uniformly distributed.
    half_window: Time,
    /// Random words for the instants: each edge has a block of its own.
    words: ChaCha8Rng,
    pace: Pace,
}

impl Disturbance {
    /// Registers that sample anywhere within `window` about an edge, by `words`, of a chain whose delays follow
    /// `pace`.
    pub fn new(window: Time, words: ChaCha8Rng, pace: Pace) -> Self {
        Disturbance { half_window: Time::from_fs(window.fs() / 2), words, pace }
    }

    /// Returns the same disturbance with other random words.
    pub fn with_words(self, words: ChaCha8Rng) -> Self {
        Disturbance { words, ..self }
    }

    /// Samples the taps at an edge, with the pin at `level`, of a chain that has these delays at a pace of 1.
    #[cold]
    pub fn sample(
        &mut self,
        level: bool,
        transitions: &Transitions,
        now: Time,
        delays: &Delays,
    ) -> Taps {
        let pace = self.pace.at(now);
        // A whole number stays one at a pace of 1.
        let usual = |age: Time| Time::from_fs((age.fs() as f64 / pace).round() as u64);
        let end = delays.longest() + self.half_window;
        let ages: Vec<_> = transitions.ages(now).map(usual).take_while(|age| *age < end).collect();
        if self.half_window == Time::ZERO || ages.is_empty() {
            return Taps::clipped(delays.taps(), level, ages.iter().map(|age| delays.rank(*age)));
        }
        self.metastable(level, &ages, now, delays)
    }

    /// Samples taps of which those near each transition are high or low at random. `ages` are those of the
    /// transitions, newest first.
    ///
    /// If [`Taps`] has no room for all of those, only the taps nearest to each transition are random.
    fn metastable(&mut self, level: bool, ages: &[Time], now: Time, delays: &Delays) -> Taps {
        let most = (CAPACITY / ages.len()).saturating_sub(1);
        let unsure = |age: &Time| {
            let begin = age.since(self.half_window);
            let [begin, middle, end] =
                [begin, *age, *age + self.half_window].map(|age| delays.rank(age));
            let begin = begin.max(middle.saturating_sub(most / 2));
            begin..end.min(begin + most)
        };
        let unsure: Vec<_> = ages.iter().map(unsure).collect();
        let mut taps = Taps::settled(level);
        // The level of the taps before `done`.
        let (mut shown, mut done) = (level, 0);
        let mut show = |level: bool, from: usize| {
            if level != shown {
                taps.push(from);
                shown = level;
            }
        };
        self.words.set_word_pos(u128::from(now.fs()) << 4);
        for (nth, places) in unsure.iter().enumerate() {
            for place in places.start.max(done)..places.end {
                let late = self.instant();
                let reached =
                    |age: &Time| delays.boundary(place).fs() as i64 <= age.fs() as i64 + late;
                let since = ages.iter().position(reached).unwrap_or(ages.len());
                show(level ^ (since % 2 == 1), place);
            }
            done = done.max(places.end);
            let next = unsure.get(nth + 1).map_or(delays.taps(), |next| next.start);
            if done < next {
                show(level ^ (nth % 2 == 0), done);
            }
        }
        taps
    }

    /// Draws how much later than the edge a register samples [fs].
    fn instant(&mut self) -> i64 {
        let half = self.half_window.fs() as i64;
        (uniform(self.words.next_u64()) * (2 * half + 1) as f64) as i64 - half
    }
}

#[cfg(test)]
mod tests;
