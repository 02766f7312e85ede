//! Pile-up taken out of a histogram.
//!
//! Of the shots that are still waiting when a bin begins, the part that is hit in it tells the hazard
//! there, whatever came before: h = ln(M / (M - n)) for n hits of M waiting shots (P. B. Coates, "The
//! correction for photon 'pile-up' in the measurement of radiative lifetimes", J. Phys. E 1, 878,
//! 1968). The variance is n / (M (M - n)) (Greenwood).

/// A bin without pile-up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corrected {
    /// Mean number of avalanches in the bin, if the detector never rested; 0 where unknown [1].
    pub hazard: f64,
    /// Its variance; 0 where unknown [1].
    pub variance: f64,
    /// Shots that are still waiting after the bin; with 0 of them the hazard is unknown [shots].
    pub waiting: f64,
}

/// The bins of `counts`, which are in order of time, of `shots` shots.
pub fn correct(counts: impl IntoIterator<Item = u32>, shots: u64) -> Vec<Corrected> {
    let mut before = shots;
    let bin = |count: u32| {
        let after = before.saturating_sub(count.into());
        let (had, waiting) = (before as f64, after as f64);
        before = after;
        if after == 0 {
            return Corrected::default();
        }
        let hazard = libm::log(had / waiting);
        Corrected { hazard, variance: (had - waiting) / (had * waiting), waiting }
    };
    counts.into_iter().map(bin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_hazard_is_returned() {
        let mut waiting = 60_000.0;
        let hit = 1.0 - (-0.05f64).exp();
        let counts: Vec<_> = (0..40)
            .map(|_| {
                let count = (waiting * hit).round();
                waiting -= count;
                count as u32
            })
            .collect();
        for bin in correct(counts, 60_000) {
            assert!((bin.hazard - 0.05).abs() < 5.0 / bin.waiting, "{bin:?}");
            let expected = hit / (bin.waiting / (1.0 - hit) * (1.0 - hit));
            assert!((bin.variance / expected - 1.0).abs() < 0.01, "{bin:?}");
        }
    }

    #[test]
    fn without_shots_waiting_the_hazard_is_unknown() {
        let bins = correct([2, 0, 3, 0, 7], 5);
        assert_eq!(bins[0].hazard, (5.0f64 / 3.0).ln());
        assert_eq!(bins[1], Corrected { hazard: 0.0, variance: 0.0, waiting: 3.0 });
        assert_eq!(bins[2..], [Corrected::default(); 3]);
        assert_eq!(correct([1], 0), [Corrected::default()]);
    }
}
