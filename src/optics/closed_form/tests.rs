//! Tests of codes against the firmware edge by edge, and of probabilities against the range's content.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::firmware::carry_chain::{Delays, TAPS, Transitions};
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

/// Determines the code as the firmware does: edge by edge, tap by tap.
fn sampled(t: Time, p: &tdc::Params) -> Option<u16> {
    let delays = &p.delays;
    let mut transitions = Transitions::default();
    transitions.push(t);
    for coarse in 0..8 {
        let edge = Time::from_fs((coarse + 1) * PERIOD.fs());
        let taps = transitions.sample(true, edge.max(t), delays);
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
            [span.from.fs(), span.until.fs(), span.from.fs().saturating_sub(1), span.until.fs() - 1]
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
