//! The rate of carriers in the dark, from the exponential tail of the intervals between counts: afterpulses do not
//! reach it.

use crate::kernel::Time;

use super::afterpulses::{rate, window_s};
use super::{BATCHES, FreeRunning, Measured};

/// The first run's number, after those of the afterpulses.
const RUNS: u64 = 2 << 20;
/// The longest batch, within what [`Time`] can count [s].
const LONGEST_S: f64 = 10_000.0;
/// Fewest intervals that tell a rate.
const FEWEST: u64 = 10;

/// Measures a dark count rate of `dark_hz` with about `counts` counts; `None` if there is none, or afterpulsing
/// leaves no tail.
pub fn dark_rate_hz(diode: &FreeRunning, dark_hz: f64, counts: u64) -> Option<Measured> {
    let window_s = window_s(diode);
    let batch_s = (counts as f64 / BATCHES as f64 / dark_hz).min(LONGEST_S);
    let until = Time::from_fs((batch_s * 1e15) as u64);
    let (mut tail, mut tail_s) = (0, 0.0);
    for batch in 0..BATCHES {
        let mut last = Time::ZERO;
        diode.counts([0.0, dark_hz], RUNS + batch, until, |at| {
            let beyond_s = (at - last).seconds() - window_s;
            tail += u64::from(beyond_s > 0.0);
            tail_s += beyond_s.max(0.0);
            last = at;
        });
        // What has not come by the end belongs to the wait.
        tail_s += ((until - last).seconds() - window_s).max(0.0);
    }
    (tail >= FEWEST).then(|| rate(tail, tail_s))
}
