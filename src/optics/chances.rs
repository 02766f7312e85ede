//! Probabilities of the first avalanche of a shot, in closed form.

use crate::kernel::Time;

use super::closed_form::{BinProbabilities, Bins};
use super::hazard::Hazard;

/// Probabilities of a shot whose detector is armed at the laser edge, so that the first avalanche decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chances {
    /// Probability that the TDC registers a hit at any time in the shot [1].
    pub hit: f64,
    /// Probability that the TDC registers a hit due to a laser photon [1].
    pub signal_first: f64,
    /// Mean number of hits in the histogram, that is, with a code [1].
    pub counted: f64,
    /// Mean number of laser photons' hits in the histogram [1].
    pub counted_signal: f64,
}

impl Chances {
    /// Computes the probabilities for hits with the codes of `bins`, and a TDC that registers none from `end` on.
    pub fn new(hazard: &Hazard, bins: &Bins, end: Time) -> Self {
        let mut counted_signal = 0.0;
        let mut spans = bins.spans().iter().peekable();
        while let Some(first) = spans.next() {
            // Spans without a gap are one.
            let mut until = first.until;
            while let Some(next) = spans.next_if(|next| next.from == until) {
                until = next.until;
            }
            counted_signal += hazard.signal_first(until) - hazard.signal_first(first.from);
        }
        Chances {
            hit: hit(hazard, end),
            signal_first: hazard.signal_first(end),
            counted: BinProbabilities::new(hazard, bins).of_code().iter().sum(),
            counted_signal,
        }
    }

    /// Returns the signal-to-background ratio: laser photons' hits in the histogram per hit of any other cause;
    /// `None` without other hits [1].
    pub fn signal_to_noise(&self) -> Option<f64> {
        let noise = self.counted - self.counted_signal;
        // Below this it is what sums of a thousand terms leave over.
        (noise > 1e-13).then(|| self.counted_signal / noise)
    }
}

/// Returns the probability of an avalanche before `end`.
fn hit(hazard: &Hazard, end: Time) -> f64 {
    if hazard.variation().is_none() {
        -libm::expm1(-hazard.at(end))
    } else {
        1.0 - hazard.none_before(end)
    }
}

#[cfg(test)]
mod tests {
    use crate::firmware::carry_chain::{Delays, TAPS};
    use crate::firmware::tdc;
    use crate::optics::Budget;
    use crate::optics::closed_form::tests::budget;

    use super::*;

    const END: Time = Time::from_ns(40);

    fn chances(budget: &Budget) -> Chances {
        let delays = Delays::new(Time::from_ns(2), &[12_500; TAPS]).unwrap();
        let bins = Bins::of_tdc(&tdc::Params::of_chain(delays));
        Chances::new(&Hazard::new(budget), &bins, END)
    }

    #[test]
    fn signal_and_noise_share_what_is_counted() {
        let found = chances(&budget());
        assert!((found.hit - (1.0 - (-0.9 - 0.5 * 40.0f64).exp())).abs() < 1e-12);
        assert!((found.counted - (1.0 - (-0.9 - 0.5 * 6.4f64).exp())).abs() < 1e-6);
        assert!((found.signal_first - found.counted_signal).abs() < 1e-12, "no echo past 6.4 ns");
        // Nearly what a pulse without width would have: no noise before it, and a photon in it.
        let none_before = (-0.5 * 3.336f64).exp();
        let expected = none_before * (1.0 - (-0.9f64).exp());
        assert!((found.signal_first / expected - 1.0).abs() < 0.03, "{}", found.signal_first);
        let noise = found.counted - found.counted_signal;
        assert_eq!(found.signal_to_noise(), Some(found.counted_signal / noise));
    }

    #[test]
    fn an_echo_past_the_histogram_is_a_hit_that_is_not_counted() {
        let far = Budget { mean_arrival: Time::from_ns(10), ambient_rate_hz: 1e7, ..budget() };
        let found = chances(&far);
        assert!(found.signal_first > 0.5);
        assert!(found.counted_signal.abs() < 1e-12);
        assert!((found.counted - (1.0 - (-0.064f64).exp())).abs() < 1e-6);
    }

    #[test]
    fn without_noise_there_is_no_ratio_to_it() {
        let found = chances(&Budget { ambient_rate_hz: 0.0, ..budget() });
        assert_eq!(found.signal_to_noise(), None);
        let none = chances(&Budget::default());
        assert_eq!((none.hit, none.signal_first, none.counted), (0.0, 0.0, 0.0));
        assert_eq!(none.signal_to_noise(), None);
    }
}
