//! Intervals between counts and their autocorrelation in faint light, and what those tell of afterpulses.
//!
//! Counts that follow from one another by afterpulses come within a few of their time constants; in light so faint that
//! chance brings few others, what the autocorrelation has above the chance level are those. An avalanche has one
//! afterpulse at most, with the chance q that its carrier is trapped and released after the dead time, so
//! that it has q / (1 - q) successors in the mean. The intervals beyond the window are the light's alone.
//!
//! An exponential time forgets how long it has taken, so that afterpulses come as long after the dead time as a
//! carrier stays in its trap, and time constant and q give the probability. With traps of two kinds the
//! dead time has taken more of the short ones: what is seen is a mean, and tells the probability no more.

use serde::Serialize;

use crate::kernel::Time;

use super::{BATCHES, FreeRunning, Measured};

/// The window: so many of the longest time constant after the dead time.
const WINDOW: f64 = 8.0;
/// Counts that chance brings into the window [1].
const CHANCE: f64 = 0.003;
/// Above that the counts in a window tell nothing of afterpulses [1].
const MOST_CHANCE: f64 = 0.05;
/// Bins of the autocorrelation, over the window, and of the intervals, by factors.
const BINS: usize = 80;
/// Steps to a bin of the expected autocorrelation.
const FINE: usize = 16;
/// Longest interval shown, against the mean one.
const LONGEST: f64 = 10.0;
/// Fewest afterpulses that tell their time constant.
const FEWEST: f64 = 30.0;

/// What faint light shows.
#[derive(Clone, Debug, Serialize)]
pub struct Afterpulses {
    /// Incident rate, with the dark [1/s].
    pub incident_hz: f64,
    /// Counts.
    pub counts: u64,
    /// Count rate [1/s].
    pub rate_hz: Measured,
    /// Length of the window [s].
    pub window_s: f64,
    /// Pairs of counts by their distance, in equal bins over the window.
    #[serde(skip)]
    pub pairs: Vec<u64>,
    /// Pairs of a bin by chance.
    #[serde(skip)]
    pub chance_pairs: f64,
    /// Ends of the intervals' bins [s].
    #[serde(skip)]
    pub interval_ends_s: Vec<f64>,
    /// Intervals between neighbours.
    #[serde(skip)]
    pub intervals: Vec<u64>,
    /// Rate of the exponential tail of the intervals [1/s].
    pub tail_hz: Measured,
    /// Chance q that an avalanche has an afterpulse [1].
    pub after_dead_time: Measured,
    /// Mean time from the end of the dead time until they come, if there are enough: the time constant, where there is
    /// one [s].
    pub time_constant_s: Option<Measured>,
    /// Probability that an avalanche traps a carrier, from both; unknown with two kinds of traps [1].
    pub probability: Option<Measured>,
    /// What the scenario's keys come to, q [1].
    #[serde(rename = "expected_after_dead_time")]
    pub expected: f64,
    /// What they come to for `time_constant_s` [s].
    #[serde(rename = "expected_time_constant_s")]
    pub expected_time_s: f64,
    /// Pairs of each bin that are to be expected: those by chance, and avalanches with what follows from them.
    #[serde(skip)]
    pub expected_pairs: Vec<f64>,
}

/// Measures about so many counts; `None` if the dark alone fills the window.
pub fn afterpulses(diode: &FreeRunning, dark_hz: f64, counts: u64) -> Option<Afterpulses> {
    let dead_s = diode.dead_time_s();
    let expected = Expected::of(diode);
    let window_s = window_s(diode);
    let incident_hz = dark_hz.max(CHANCE / window_s);
    if incident_hz * window_s > MOST_CHANCE {
        return None;
    }
    let batch_s = counts as f64 / BATCHES as f64 / incident_hz;
    let open_s = window_s - dead_s;
    let mut found = Sums::new(dead_s, LONGEST / incident_hz);
    let (mut rates, mut excesses) = (Vec::new(), Vec::new());
    for batch in 0..BATCHES {
        let mut times = Vec::new();
        let until = Time::from_fs((batch_s * 1e15) as u64);
        let rates_hz = [incident_hz - dark_hz, dark_hz];
        diode.counts(rates_hz, RUNS + batch, until, |at| times.push(at));
        let rate_hz = times.len() as f64 / batch_s;
        let followers = found.followers(&times, batch_s - window_s, window_s);
        found.intervals(&times, until, (window_s, dead_s));
        rates.push(rate_hz);
        excesses.push(followers - rate_hz * open_s);
    }
    let (rate_hz, excess) = (Measured::of(&rates), Measured::of(&excesses));
    let followed = 1.0 + excess.value;
    let after_dead_time =
        Measured { value: excess.value / followed, se: excess.se / followed.powi(2) };
    let tail_hz = rate(found.tail, found.tail_s);
    let mean_s = found.time_constant_s(after_dead_time.value, tail_hz.value, open_s);
    let time_constant_s = mean_s.map(|mean| Measured { se: mean.se * expected.scatter, ..mean });
    let probability = time_constant_s
        .filter(|_| expected.is_of_one_kind)
        .map(|constant| probability(after_dead_time, constant, dead_s));
    let bin_s = window_s / BINS as f64;
    let chance_pairs = found.begun as f64 * rate_hz.value * bin_s;
    // Nothing comes within the dead time, not even by chance.
    let open = |k: usize| ((k + 1) as f64 - dead_s / bin_s).clamp(0.0, 1.0);
    let followed = successors(diode, bin_s).into_iter().enumerate();
    let pairs = followed.map(|(k, own)| open(k) * chance_pairs + own * found.begun as f64);
    Some(Afterpulses {
        expected_pairs: pairs.collect(),
        incident_hz,
        counts: found.intervals.iter().sum::<u64>() + BATCHES,
        rate_hz,
        window_s,
        chance_pairs,
        pairs: found.pairs,
        interval_ends_s: found.ends_s,
        intervals: found.intervals,
        tail_hz,
        after_dead_time,
        time_constant_s,
        probability,
        expected: expected.after_dead_time,
        expected_time_s: expected.mean_s,
    })
}

/// Returns the probability that an avalanche traps a carrier, from that of an afterpulse after the dead time and the
/// time constant [1].
fn probability(after_dead_time: Measured, constant: Measured, dead_s: f64) -> Measured {
    let [q, rest] = [after_dead_time.value, dead_s / constant.value];
    let parts = [after_dead_time.se / q, rest * constant.se / constant.value];
    let value = q * rest.exp();
    Measured { value, se: value * parts[0].hypot(parts[1]) }
}

/// Returns the mean number of afterpulses, and of their afterpulses in turn, that follow an avalanche in each bin of
/// the window [1].
///
/// An avalanche at a given time is an afterpulse of the first avalanche, or of one that came before it: a sum over
/// small steps.
fn successors(diode: &FreeRunning, bin_s: f64) -> Vec<f64> {
    let step_s = bin_s / FINE as f64;
    let late = |k: usize| {
        let at_s = (k as f64 * step_s).max(diode.dead_time_s());
        diode.effects.released_after(at_s * 1e15)
    };
    let own: Vec<f64> = (0..BINS * FINE).map(|k| late(k) - late(k + 1)).collect();
    let mut all: Vec<f64> = Vec::with_capacity(own.len());
    for k in 0..own.len() {
        // Times within two steps add up to one within the step of their sum as often as within the next one.
        let through = all.iter().enumerate().map(|(j, all)| all * (own[k - j] + own[k - 1 - j]));
        let through = through.sum::<f64>();
        all.push((own[k] + 0.5 * through) / (1.0 - 0.5 * own[0]));
    }
    all.chunks(FINE).map(|steps| steps.iter().sum()).collect()
}

/// Values expected from the keys.
struct Expected {
    /// q [1].
    after_dead_time: f64,
    /// Mean time of an afterpulse from the end of the dead time [s].
    mean_s: f64,
    /// Standard deviation of that time, against its mean [1].
    scatter: f64,
    /// Whether carriers are in traps of one kind.
    is_of_one_kind: bool,
}

impl Expected {
    fn of(diode: &FreeRunning) -> Self {
        let (effects, dead_fs) = (&diode.effects, diode.dead_time_s() * 1e15);
        let traps = effects.traps().into_iter().filter(|(share, _)| *share > 0.0);
        // What the dead time leaves of each kind, and its mean time.
        let left: Vec<_> =
            traps.map(|(share, fs)| (share * (-dead_fs / fs).exp(), fs * 1e-15)).collect();
        let all = left.iter().map(|(part, _)| part).sum::<f64>();
        let moment = |power| left.iter().map(|(part, s)| part * s.powi(power)).sum::<f64>() / all;
        let is_of_one_kind = left.len() == 1;
        let (mean_s, squares) = (moment(1), 2.0 * moment(2));
        let scatter = (squares / (mean_s * mean_s) - 1.0).sqrt();
        Expected {
            after_dead_time: effects.released_after(dead_fs),
            mean_s: if is_of_one_kind { left[0].1 } else { mean_s },
            scatter: if is_of_one_kind { 1.0 } else { scatter },
            is_of_one_kind,
        }
    }
}

/// The first run's number, after those of the count rates.
const RUNS: u64 = 1 << 20;

/// Time within which afterpulses come [s].
pub(super) fn window_s(diode: &FreeRunning) -> f64 {
    diode.dead_time_s() + WINDOW * diode.effects.longest_trap_fs() * 1e-15
}

/// Rate of an exponential time, of which so many come to a sum [1/s].
pub(super) fn rate(count: u64, sum_s: f64) -> Measured {
    let (count, value) = (count as f64, count as f64 / sum_s);
    Measured { value, se: value / count.sqrt() }
}

/// Sums over all batches.
struct Sums {
    begun: u64,
    pairs: Vec<u64>,
    ends_s: Vec<f64>,
    intervals: Vec<u64>,
    /// Intervals longer than the window, and by how much [s].
    tail: u64,
    tail_s: f64,
    /// The others, and how much longer than the dead time [s].
    short: u64,
    short_s: f64,
}

impl Sums {
    fn new(from_s: f64, until_s: f64) -> Self {
        let end = |k: usize| from_s * (until_s / from_s).powf(k as f64 / BINS as f64);
        Sums {
            begun: 0,
            pairs: vec![0; BINS],
            ends_s: (0..=BINS).map(end).collect(),
            intervals: vec![0; BINS],
            tail: 0,
            tail_s: 0.0,
            short: 0,
            short_s: 0.0,
        }
    }

    /// Adds the pairs of counts within the window, of counts before `last_s`. Returns the mean number of counts that
    /// follow one [1].
    fn followers(&mut self, times: &[Time], last_s: f64, window_s: f64) -> f64 {
        let (mut begun, mut pairs) = (0u64, 0u64);
        for (k, &time) in times.iter().enumerate().filter(|(_, time)| time.seconds() < last_s) {
            begun += 1;
            let lags_s = times[k + 1..].iter().map(|later| (*later - time).seconds());
            for lag_s in lags_s.take_while(|lag_s| *lag_s <= window_s) {
                self.pairs[((lag_s / window_s * BINS as f64) as usize).min(BINS - 1)] += 1;
                pairs += 1;
            }
        }
        self.begun += begun;
        pairs as f64 / begun.max(1) as f64
    }

    /// Adds the intervals between the counts of a batch, and the wait from the last one to its end.
    fn intervals(&mut self, times: &[Time], until: Time, (window_s, dead_s): (f64, f64)) {
        for pair in times.windows(2) {
            self.interval((pair[1] - pair[0]).seconds(), window_s, dead_s);
        }
        let last = times.last().copied().unwrap_or(Time::ZERO);
        self.tail_s += ((until - last).seconds() - window_s).max(0.0);
    }

    fn interval(&mut self, interval_s: f64, window_s: f64, dead_s: f64) {
        let bin = self.ends_s.partition_point(|end| *end <= interval_s);
        self.intervals[bin.clamp(1, BINS) - 1] += 1;
        if interval_s > window_s {
            self.tail += 1;
            self.tail_s += interval_s - window_s;
        } else {
            self.short += 1;
            self.short_s += interval_s - dead_s;
        }
    }

    /// The mean of the afterpulses among the short intervals.
    fn time_constant_s(&self, q: f64, light_hz: f64, open_s: f64) -> Option<Measured> {
        let by_chance = (1.0 - q) * (self.short + self.tail) as f64 * light_hz * open_s;
        let count = self.short as f64 - by_chance;
        let value = (self.short_s - by_chance * open_s / 2.0) / count;
        let are_enough = count > FEWEST + 5.0 * by_chance.max(0.0).sqrt() && value > 0.0;
        are_enough.then(|| Measured { value, se: value * (count + by_chance).sqrt() / count })
    }
}
