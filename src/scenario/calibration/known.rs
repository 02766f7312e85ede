//! The chain that a calibration takes its hits to come through.
//!
//! Who reckons with the bins (an estimator) knows of a chain what its calibration found, and no more. A file has for
//! each `n` the middle of the ages that give it. Those of a code density follow one another without a gap: then each
//! interval ends as far behind its middle as it begins before it, and all follow from where the first one begins,
//! at tap 0. Ages that do not add up so are taken to change from one `n` to the next half-way.

use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

/// By how much an interval may end before it begins, for the digits of a file [ps].
const ROUNDING_PS: f64 = 0.1;

/// A chain in order with tap `n` reached where `n - 1` ends, from the age for each `n` [ps] and when tap 0 is
/// reached. `None` without ages of a chain.
pub fn chain(ages_ps: &[f64], tap_0: Time) -> Option<Delays> {
    let tap_0_ps = tap_0.fs() as f64 * 1e-3;
    // No hit is as young.
    let ages_ps: Vec<_> = ages_ps.iter().map(|age| age.max(tap_0_ps)).collect();
    let ends_ps = intervals(&ages_ps, tap_0_ps).unwrap_or_else(|| halfway(&ages_ps));
    let ends: Vec<_> = ends_ps.iter().map(|ps| (ps * 1e3).round() as i64).collect();
    let widths: Vec<_> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
    Delays::new(Time::from_fs(u64::try_from(*ends.first()?).ok()?), &widths)
}

/// Where each interval ends if all follow one another from `begin_ps` on [ps].
fn intervals(ages_ps: &[f64], begin_ps: f64) -> Option<Vec<f64>> {
    let mut begin = begin_ps;
    let ends = ages_ps.iter().map(|age| {
        let end = 2.0 * age - begin;
        begin = begin.max(end);
        (end > begin - ROUNDING_PS).then_some(begin)
    });
    ends.collect()
}

/// Where each ends if they change half-way; of ages out of order, the highest before [ps].
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

    /// The middle of each interval of ages, to the digits of a file.
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
