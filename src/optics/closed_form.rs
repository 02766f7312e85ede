//! The histogram of a frame in one step, for SPAD mode 0, where the first avalanche decides.
//!
//! A bin has the probability `exp(-H(a)) - exp(-H(b))`, summed over the times that give its code;
//! which times those are depends on the carry chain. What is left over has no code.

use rand::Rng;
use rand_distr::{Binomial, Distribution};

use crate::firmware::tdc;
use crate::firmware::tdc_decoder::TimeScale;
use crate::kernel::Time;

use super::hazard::Hazard;

/// A span of avalanche times that give one code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// First time, from the laser edge.
    pub from: Time,
    /// First time after it.
    pub until: Time,
    /// Code of the TDC [bins].
    pub code: u16,
}

/// Which avalanche times give which code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bins {
    /// In order of time, without overlap.
    spans: Vec<Span>,
    /// What a code is meant to be.
    scale: TimeScale,
}

impl Bins {
    /// Of a converter.
    ///
    /// The chain has to be clear again before the next shot's first edge, 2 periods after
    /// `spad_rst` rises, or a hit would be counted together with the one before.
    pub fn of_tdc(p: &tdc::Params) -> Self {
        let (delays, period) = (&p.delays, p.decoder.scale.period());
        let mut spans = Vec::new();
        let (tap_0, ages) = (delays.tap_0(), delays.arrivals());
        for coarse in 0..p.coarse_counter.window() {
            let edge = Time::from_fs((coarse + 1) * period.fs());
            if (1..=ages.len()).all(|n| p.decoder.is_late(coarse, n)) {
                break;
            }
            // The first edge at or after the arrival at tap 0 sees the avalanche.
            let first = first_younger(tap_0 + period, edge);
            let end = first_younger(tap_0, edge);
            for n in (1..=ages.len()).rev() {
                let Some(code) = p.decoder.code(coarse, n) else { continue };
                let from = ages.get(n).map_or(first, |&age| first_younger(age, edge).max(first));
                let until = first_younger(ages[n - 1], edge).min(end);
                push(&mut spans, Span { from, until, code: code.get() as u16 });
            }
        }
        Bins { spans, scale: p.decoder.scale }
    }

    /// The spans of all codes, in order of time.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.scale.bins()
    }

    /// Where each bin begins, and last where the last one ends, as far as codes follow time: a code that none has
    /// is a bin without width [ps].
    pub fn edges_ps(&self) -> Vec<f64> {
        let mut edges = vec![0.0; self.count() + 1];
        for span in &self.spans {
            let end = &mut edges[span.code as usize + 1];
            *end = f64::max(*end, span.until.fs() as f64 * 1e-3);
        }
        for bin in 1..edges.len() {
            edges[bin] = edges[bin].max(edges[bin - 1]);
        }
        edges
    }

    /// Width of a bin, as codes count it [ps].
    pub fn bin_ps(&self) -> f64 {
        self.scale.bin().fs() as f64 * 1e-3
    }

    /// Time at which bin 0 begins, as codes count it [ps].
    pub fn first_ps(&self) -> f64 {
        self.scale.first().fs() as f64 * 1e-3
    }

    /// Place of a time from the laser edge [ps] among the bins, as codes count them [bins].
    pub fn place(&self, ps: f64) -> f64 {
        (ps - self.first_ps()) / self.bin_ps()
    }

    /// Whether codes count what the KC705's do.
    pub fn are_kc705(&self) -> bool {
        let kc705 = |scale: &TimeScale| (scale.bin(), scale.first(), scale.bins());
        kc705(&self.scale) == kc705(&TimeScale::default())
    }

    /// Code of an avalanche at `t` from the laser edge.
    pub fn code_at(&self, t: Time) -> Option<u16> {
        let next = self.spans.partition_point(|span| span.from <= t);
        let span = self.spans[..next].last()?;
        (t < span.until).then_some(span.code)
    }
}

/// First time of an avalanche that at `edge` is younger than `age`.
fn first_younger(age: Time, edge: Time) -> Time {
    (edge + Time::from_fs(1)).since(age)
}

/// Appends a span, if there is anything of it, to the one before if they are one.
fn push(spans: &mut Vec<Span>, span: Span) {
    if span.from >= span.until {
        return;
    }
    match spans.last_mut() {
        Some(last) if last.until == span.from && last.code == span.code => last.until = span.until,
        _ => spans.push(span),
    }
}

/// The probability of each code in one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct BinProbabilities(Vec<f64>);

impl BinProbabilities {
    /// Of shots that are armed at the laser edge.
    pub fn new(hazard: &Hazard, bins: &Bins) -> Self {
        let mut of_code = vec![0.0; bins.count()];
        // Hazard, and probability of no avalanche, up to where we are.
        let (mut at, mut none_yet) = (0.0, 1.0);
        let mut advance = |t: Time| {
            let to = hazard.at(t);
            let probability = -none_yet * libm::expm1(at - to);
            none_yet -= probability;
            at = to;
            probability
        };
        for span in &bins.spans {
            advance(span.from);
            of_code[span.code as usize] += advance(span.until);
        }
        BinProbabilities(of_code)
    }

    /// By code.
    pub fn of_code(&self) -> &[f64] {
        &self.0
    }

    /// A histogram of `shots` shots: multinomial, as a binomial draw for each code from the shots
    /// that are left.
    pub fn draw(&self, shots: u64, rng: &mut impl Rng) -> Vec<u64> {
        let mut histogram = vec![0; self.0.len()];
        let (mut shots_left, mut probability_left) = (shots, 1.0);
        for (count, &probability) in histogram.iter_mut().zip(&self.0) {
            if shots_left == 0 || probability == 0.0 {
                continue;
            }
            let share =
                if probability < probability_left { probability / probability_left } else { 1.0 };
            *count = Binomial::new(shots_left, share).map_or(0, |binomial| binomial.sample(rng));
            shots_left -= *count;
            probability_left -= probability;
        }
        histogram
    }
}

#[cfg(test)]
pub(super) mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use crate::firmware::carry_chain::{Delays, StopLine, TAPS};
    use crate::kernel::U;
    use crate::optics::Budget;

    use super::*;

    const PERIOD: Time = Time::from_ns(8);

    fn uniform(tap_fs: i64, offset_ps: u64) -> Delays {
        Delays::new(Time::from_fs(offset_ps * 1000), &[tap_fs; TAPS]).unwrap()
    }

    fn bins(delays: &Delays) -> Bins {
        Bins::of_tdc(&tdc::Params::of_chain(delays.clone()))
    }

    /// A chain whose taps are not reached in order, as in a real device.
    fn uneven() -> Delays {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let delays: Vec<_> = (0..TAPS).map(|_| rng.random_range(-20_000..44_000)).collect();
        Delays::new(Time::from_fs(2_500_000), &delays).unwrap()
    }

    /// Code as the firmware finds it: edge by edge, tap by tap.
    fn sampled(t: Time, p: &tdc::Params) -> Option<u16> {
        let delays = &p.delays;
        let mut line = StopLine::default();
        line.toggle(t);
        for coarse in 0..8 {
            let edge = Time::from_fs((coarse + 1) * PERIOD.fs());
            let taps = line.sample(edge.max(t), delays);
            if edge >= t && taps.tap(delays.tap_0_position()) {
                let code = p.decoder.code(coarse, taps.ones(TAPS));
                return code.map(|code| code.get() as u16);
            }
        }
        None
    }

    #[test]
    fn a_code_is_what_the_firmware_samples() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for delays in [uniform(11_500, 2_230), uniform(12_500, 2_000), uneven()] {
            let params = tdc::Params::of_chain(delays);
            let bins = Bins::of_tdc(&params);
            let borders = bins.spans().iter().flat_map(|span| {
                [
                    span.from.fs(),
                    span.until.fs(),
                    span.from.fs().saturating_sub(1),
                    span.until.fs() - 1,
                ]
            });
            let random: Vec<_> = (0..20_000).map(|_| rng.random_range(0..80_000_000)).collect();
            for t in borders.chain(random).map(Time::from_fs) {
                assert_eq!(bins.code_at(t), sampled(t, &params), "{t}");
            }
        }
    }

    #[test]
    fn spans_are_in_order_and_do_not_overlap() {
        for delays in [uniform(11_500, 2_230), uneven()] {
            let bins = bins(&delays);
            assert!(bins.spans().iter().all(|span| span.from < span.until));
            assert!(bins.spans().windows(2).all(|pair| pair[0].until <= pair[1].from));
        }
    }

    #[test]
    fn ideal_taps_give_bins_of_25_ps() {
        let bins = bins(&uniform(12_500, 2_000));
        assert_eq!(bins.code_at(Time::ZERO), Some(0));
        for span in &bins.spans()[2..250] {
            assert_eq!(span.until - span.from, Time::from_fs(25_000), "{span:?}");
        }
        assert_eq!(bins.code_at(Time::from_fs(6_400_001)), None);
    }

    /// A bright target near the middle of the range.
    pub(in crate::optics) fn budget() -> Budget {
        Budget {
            signal_per_shot: 0.9,
            ambient_rate_hz: 0.5e9,
            mean_arrival: Time::from_fs(3_336_000),
            pulse_sigma_ps: 137.0,
            ..Budget::default()
        }
    }

    #[test]
    fn the_probabilities_are_what_the_range_holds() {
        let hazard = Hazard::new(&budget());
        let bins = bins(&uniform(12_500, 2_000));
        let found: f64 = BinProbabilities::new(&hazard, &bins).of_code().iter().sum();
        let end = bins.spans().last().unwrap().until;
        assert_eq!(bins.spans()[0].from, Time::ZERO);
        assert!((found - (1.0 - (-hazard.at(end)).exp())).abs() < 1e-14);
    }

    #[test]
    fn a_bin_is_the_difference_of_two_survivals() {
        let hazard = Hazard::new(&budget());
        let whole = tdc::Params::of_chain(uneven());
        let mut with_holes = whole.clone();
        with_holes.decoder.cal[300..310].fill(U::new(0));
        for params in [whole, with_holes] {
            let bins = Bins::of_tdc(&params);
            let mut expected = vec![0.0; bins.count()];
            for span in bins.spans() {
                let survival = |t| (-hazard.at(t)).exp();
                expected[span.code as usize] += survival(span.from) - survival(span.until);
            }
            let found = BinProbabilities::new(&hazard, &bins);
            for (found, expected) in found.of_code().iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn every_shot_is_drawn_once() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut sure = vec![0.0; 256];
        (sure[3], sure[200]) = (0.25, 0.75);
        let histogram = BinProbabilities(sure).draw(30_000, &mut rng);
        assert_eq!(histogram[3] + histogram[200], 30_000);
        assert!((7_000..8_000).contains(&histogram[3]));
        assert_eq!(BinProbabilities(vec![0.0; 256]).draw(30_000, &mut rng), [0; 256]);
    }

    #[test]
    fn without_any_rate_no_code_is_probable() {
        let hazard = Hazard::dark(&Budget::default());
        let none = BinProbabilities::new(&hazard, &bins(&uniform(11_500, 2_230)));
        assert_eq!(none.of_code(), [0.0; 256]);
    }
}
