//! The chain that a calibration implies.
//!
//! Estimators know the chain's bins only through the calibration. A calibration file lists, for each ones count `n`,
//! the midpoint of the ages that produce it. A code-density test gives contiguous intervals, so each interval ends as
//! far after its midpoint as it starts before it, and all of them follow from the start of the first one, at tap 0.
//! If the midpoints are not consistent with contiguous intervals, the boundaries are taken half-way between
//! neighbouring ages.

use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

/// Largest overlap of neighbouring intervals that is attributed to rounding in the file [ps].
const ROUNDING_PS: f64 = 0.1;

/// Builds an ordered chain whose tap `n` is reached where interval `n - 1` ends, from the age for each `n` [ps] and
/// the time at which tap 0 is reached. Returns `None` if the ages do not describe a chain.
pub fn chain(ages_ps: &[f64], tap_0: Time) -> Option<Delays> {
    let tap_0_ps = tap_0.fs() as f64 * 1e-3;
    // No hit is as young.
    let ages_ps: Vec<_> = ages_ps.iter().map(|age| age.max(tap_0_ps)).collect();
    let ends_ps = intervals(&ages_ps, tap_0_ps).unwrap_or_else(|| halfway(&ages_ps));
    let ends: Vec<_> = ends_ps.iter().map(|ps| (ps * 1e3).round() as i64).collect();
    let widths: Vec<_> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
    Delays::new(Time::from_fs(u64::try_from(*ends.first()?).ok()?), &widths)
}

/// Returns the end of each interval, if contiguous intervals from `begin_ps` have the given midpoints [ps].
fn intervals(ages_ps: &[f64], begin_ps: f64) -> Option<Vec<f64>> {
    let mut begin = begin_ps;
    let ends = ages_ps.iter().map(|age| {
        let end = 2.0 * age - begin;
        begin = begin.max(end);
        (end > begin - ROUNDING_PS).then_some(begin)
    });
    ends.collect()
}

/// Returns the half-way boundaries between neighbouring ages; ages that decrease are raised to the previous maximum
/// [ps].
fn halfway(ages_ps: &[f64]) -> Vec<f64> {
    let mut last = 0.0;
    let mut ends: Vec<_> = ages_ps
        .windows(2)
        .map(|pair| {
            last = f64::max(last, (pair[0] + pair[1]) / 2.0);
            last
        })
        .collect();
    // The last is as long behind its middle as before it.
    let end = ages_ps.last().map_or(last, |age| last.max(2.0 * age - last));
    ends.push(end);
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAPS: usize = 16;

    fn uneven() -> Delays {
        let delays: Vec<_> = (0..TAPS as i64).map(|tap| (tap * 7919 % 1_000) * 1_000).collect();
        Delays::new(Time::from_ns(2), &delays).unwrap()
    }

    /// Midpoint of each interval of ages, rounded as in a calibration file.
    fn middles(delays: &Delays) -> Vec<f64> {
        let middle = |n: usize| match n {
            0 => 1.0,
            n => (delays.boundary(n - 1) + delays.boundary(n)).fs() as f64 / 2e3,
        };
        (0..=TAPS).map(|n| (middle(n) * 1e3).round() / 1e3).collect()
    }

    #[test]
    fn middles_of_intervals_tell_where_they_end() {
        let own = uneven();
        let known = chain(&middles(&own), own.tap_0()).unwrap();
        for n in 0..=TAPS {
            let off = known.boundary(n).fs().abs_diff(own.boundary(n).fs());
            assert!(off <= 20, "{n}: {off} fs");
        }
    }

    #[test]
    fn taps_without_hits_have_no_width() {
        let mut ages = middles(&uneven());
        ages[5] = uneven().boundary(4).fs() as f64 * 1e-3;
        ages.truncate(6);
        ages.resize(TAPS + 1, ages[5]);
        let known = chain(&ages, uneven().tap_0()).unwrap();
        assert_eq!(known.boundary(4), known.boundary(TAPS));
    }

    #[test]
    fn ages_that_do_not_add_up_change_half_way() {
        let mut ages = middles(&uneven());
        ages[3] += 2_000.0;
        let known = chain(&ages, uneven().tap_0()).unwrap();
        let half = |n: usize| (ages[n] + ages[n + 1]) / 2.0;
        assert_eq!(known.boundary(1).fs(), (half(1) * 1e3).round() as u64);
        assert_eq!(known.boundary(4), known.boundary(3), "ages out of order");
        assert!(known.boundary(TAPS) > known.boundary(TAPS - 1));
    }
}
