//! What makes a chain another at each edge: registers that sample too early or too late, and delays that grow and
//! shrink with the conditions of the die.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::kernel::Time;
use crate::kernel::thermometer::CAPACITY;

use super::delays::{Delays, Taps};

/// How much faster or slower than its [`Delays`] a chain is, over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pace(Vec<(Time, f64)>);

impl Pace {
    /// Of points in the order of their times: how many times as long as the chain's each delay is then. Between
    /// two points it is linear, before the first and after the last it stands still.
    pub fn new(points: Vec<(Time, f64)>) -> Self {
        Pace(points)
    }

    /// How many times as long each delay is at `now`.
    pub fn at(&self, now: Time) -> f64 {
        let after = self.0.partition_point(|(at, _)| *at <= now);
        let Some(&(then, from)) = after.checked_sub(1).and_then(|before| self.0.get(before)) else {
            return self.0.first().map_or(1.0, |(_, factor)| *factor);
        };
        let Some(&(next, to)) = self.0.get(after) else { return from };
        from + (to - from) * ((now - then).fs() as f64 / (next - then).fs() as f64)
    }
}

/// The state of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Half of the time about an edge within which a register samples, at any instant alike.
    half_window: Time,
    /// Where in it: for each edge a block of words of its own.
    words: ChaCha8Rng,
    pace: Pace,
}

impl Disturbance {
    /// Registers that sample anywhere within `window` about an edge, by `words`, of a chain whose delays follow
    /// `pace`.
    pub fn new(window: Time, words: ChaCha8Rng, pace: Pace) -> Self {
        Disturbance { half_window: Time::from_fs(window.fs() / 2), words, pace }
    }

    /// The ages at which a chain of the usual delays shows what this one does at `now`, of transitions of these.
    pub(super) fn usual(&self, ages: &mut [Time], now: Time) {
        let pace = self.pace.at(now);
        ages.iter_mut()
            .for_each(|age| *age = Time::from_fs((age.fs() as f64 / pace).round() as u64));
    }

    pub(super) fn half_window(&self) -> Time {
        self.half_window
    }

    /// The taps at an edge at which the input is at a level, after transitions of these ages, the newest first.
    ///
    /// Where more transitions travel than a [`Taps`] has room for the taps about, those nearest to the edge
    /// are random, and the others are by the tie rule.
    pub(super) fn sample(
        &mut self,
        (level, ages): (bool, &[Time]),
        now: Time,
        delays: &Delays,
    ) -> Taps {
        let taps = delays.taps();
        if self.half_window == Time::ZERO {
            return Taps::clipped(taps, level, ages.iter().map(|age| delays.rank(*age)));
        }
        let most = (CAPACITY / ages.len().max(1)).saturating_sub(1);
        let unsure = |age: &Time| {
            let [begin, middle, end] =
                [*age - self.half_window.min(*age), *age, *age + self.half_window];
            let begin = delays.rank(begin).max(delays.rank(middle).saturating_sub(most / 2));
            begin..delays.rank(end).min(begin + most)
        };
        let unsure: Vec<_> = ages.iter().map(unsure).collect();
        let mut out = Taps::settled(level);
        // The level of the taps before `done`.
        let (mut shown, mut done) = (level, 0);
        let mut show = |level: bool, from: usize| {
            if level != shown {
                out.push(from);
                shown = level;
            }
        };
        self.words.set_word_pos(u128::from(now.fs()) << 4);
        for (nth, range) in unsure.iter().enumerate() {
            for place in range.start.max(done)..range.end {
                let late = self.instant();
                let reached =
                    |age: &&Time| delays.boundary(place).fs() as i64 <= age.fs() as i64 + late;
                let by = ages.iter().position(|age| reached(&age)).unwrap_or(ages.len());
                show(level ^ (by % 2 == 1), place);
            }
            done = done.max(range.end);
            let next = unsure.get(nth + 1).map_or(taps, |next| next.start);
            if done < next {
                show(level ^ (nth % 2 == 0), done);
            }
        }
        out
    }

    /// How much later than the edge a register samples [fs].
    fn instant(&mut self) -> i64 {
        let (width, word) = (2 * self.half_window.fs() as i64 + 1, self.words.next_u64() >> 11);
        let part = word as f64 / (1u64 << 53) as f64;
        (part * width as f64) as i64 - self.half_window.fs() as i64
    }
}

#[cfg(test)]
mod tests;
