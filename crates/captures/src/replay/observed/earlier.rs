//! Shots before the first one of a window, as far as their late effects are visible.

use std::collections::BTreeMap;

use super::{Begin, Observed, Pace, Shot};

/// Assumed number of shots from the one whose code is held as the capture begins to the first one.
const HELD_SINCE: i64 = 3;

impl Observed {
    /// Adds the shots before the first of each window, as far as the windows show them.
    pub(super) fn add_earlier(&mut self, pace: Pace<'_>) {
        let Some(period) = self.period else { return };
        for begin in self.windows.clone().into_iter().rev() {
            if begin.first < self.shots.len() {
                self.add_before(Pace { period, ..pace }, begin);
            }
        }
    }

    /// Adds the shots before the first of a window, as far as it shows them, and the code that the TDC still holds.
    fn add_before(&mut self, pace: Pace<'_>, Begin { first: place, stops, codes, held }: Begin) {
        let first = self.shots[place].clone();
        let last = place.checked_sub(1).map(|last| self.shots[last].number);
        let [to_code, period] =
            [pace.to_code, pace.period].map(|cycles| (cycles * self.timebase.per_cycle) as i64);
        let begin = |back: i64| first.start - back * period;
        // By how many shots before the first.
        let mut earlier = BTreeMap::<i64, Shot>::new();
        if !stops.is_empty() {
            earlier.entry(1).or_default().stops = stops;
        }
        for (code, at) in codes {
            let back = (begin(0) + to_code - at + period - 1).div_euclid(period).max(1);
            earlier.entry(back).or_default().code = Some((code, at));
        }
        if let Some(code) = held.filter(|&code| code > 0) {
            let shot = earlier.entry(HELD_SINCE).or_default();
            shot.code = shot.code.or(Some((code, begin(HELD_SINCE) + to_code)));
        }
        for (back, shot) in earlier {
            let number = first.number.checked_sub(back as u64);
            let is_new = |&number: &u64| last.is_none_or(|last| number > last);
            if let Some(number) = number.filter(is_new) {
                self.shots.insert(place, Shot { number, start: begin(back), ..shot });
            }
        }
    }
}
