use rand_chacha::rand_core::SeedableRng;

use super::*;
use crate::firmware::carry_chain::{TAPS, Transitions};

const WINDOW: Time = Time::from_fs(40_000);

fn delays() -> Delays {
    Delays::new(Time::from_ns(2), &[11_000; TAPS]).unwrap()
}

fn disturbance(window: Time, seed: u64, pace: Pace) -> Disturbance {
    Disturbance::new(window, ChaCha8Rng::seed_from_u64(seed), pace)
}

/// One hit, which is so old at `now`.
fn hit(age: Time, now: Time) -> Transitions {
    let mut transitions = Transitions::default();
    transitions.push(now - age);
    transitions
}

#[test]
fn without_a_window_and_at_a_steady_pace_taps_are_the_usual_ones() {
    let (delays, mut level, mut transitions) = (delays(), false, Transitions::default());
    let mut disturbance = disturbance(Time::ZERO, 1, Pace::new(vec![(Time::ZERO, 1.0)]));
    // From power-up on; pulses of all lengths, some of them of none, and sometimes more than are kept.
    let mut now = Time::ZERO;
    for k in 0..5_000u64 {
        if k % 3 > 0 {
            let at = now + Time::from_fs(k * 7_919_000 % 1_900_000);
            let burst = if k % 40 == 1 { 9 } else { 0 };
            let last = at + Time::from_fs(burst * 9_000);
            let mut toggle = |at| {
                level = !level;
                transitions.push(at);
            };
            (0..=burst).for_each(|nth| toggle(at + Time::from_fs(nth * 9_000)));
            if k % 7 == 0 || burst > 0 {
                toggle(last);
            }
        }
        now += Time::from_ns(2);
        let found = disturbance.sample(level, &transitions, now, &delays);
        assert_eq!(found, transitions.sample(level, now, &delays), "{k}");
    }
}

#[test]
fn a_chain_of_another_pace_shows_what_a_stretched_one_does() {
    let slow = delays().stretched(1.04).unwrap();
    let pace = Pace::new(vec![(Time::from_ns(1000), 1.0), (Time::from_ns(2000), 1.04)]);
    let mut disturbance = disturbance(Time::ZERO, 1, pace);
    for (now, delays) in [(Time::from_ns(900), &delays()), (Time::from_ns(3000), &slow)] {
        for k in 0..2_000u64 {
            // Off the boundaries by more than rounding.
            let age = Time::from_fs(k * 6_007 + 3);
            let mut hit = hit(age, now);
            let found = disturbance.sample(true, &hit, now, &self::delays());
            assert_eq!(found, hit.sample(true, now, delays), "{now:?} {k}");
        }
    }
}

#[test]
fn a_tap_within_the_window_is_high_as_often_as_its_register_samples_late() {
    let (delays, draws) = (delays(), 40_000u64);
    let mut disturbance = disturbance(WINDOW, 1, Pace::default());
    // Taps 100 .. 103 are reached 15, 4 ps before the edge, and 7, 18 ps after it.
    let age = Time::from_fs(delays.boundary(100).fs() + 15_000);
    let mut high = [0u64; 6];
    for k in 0..draws {
        let now = Time::from_ns(1000 + 40 * k);
        let taps = disturbance.sample(true, &hit(age, now), now, &delays);
        (0..6).for_each(|tap| high[tap] += u64::from(taps.tap(99 + tap)));
    }
    for (tap, chance) in
        [(0, 1.0), (1, 35.0 / 40.0), (2, 0.6), (3, 13.0 / 40.0), (4, 0.05), (5, 0.0f64)]
    {
        let expected = chance * draws as f64;
        let allowed = 4.0 * (expected * (1.0 - chance)).sqrt() + 4.0;
        assert!(
            (high[tap] as f64 - expected).abs() <= allowed,
            "{tap}: {} for {expected}",
            high[tap]
        );
    }
}

#[test]
fn registers_draw_by_themselves_and_the_same_again() {
    let delays = delays();
    let sampled = |seed| {
        let mut disturbance = disturbance(WINDOW, seed, Pace::default());
        let age = Time::from_fs(delays.boundary(100).fs() + 15_000);
        let of = |k: u64| {
            let now = Time::from_ns(1000 + 40 * k);
            disturbance.sample(true, &hit(age, now), now, &delays)
        };
        (0..1000).map(of).collect::<Vec<_>>()
    };
    let first = sampled(1);
    assert_eq!(first, sampled(1));
    assert_ne!(first, sampled(2));
    // Tap 102 may be high where tap 101 is low: 0.4 of 0.325 of all.
    let bubbles = first.iter().filter(|taps| !taps.tap(101) && taps.tap(102)).count();
    assert!((bubbles as f64 - 130.0).abs() < 4.0 * (1000.0f64 * 0.13 * 0.87).sqrt(), "{bubbles}");
    // Both edges of a pulse, and an edge of the other kind.
    let now = Time::from_ns(500);
    let mut pulse = hit(Time::from_ns(7), now);
    pulse.push(now - Time::from_ns(4));
    let taps = disturbance(WINDOW, 1, Pace::default()).sample(false, &pulse, now, &delays);
    let (from, to) = (delays.rank(Time::from_ns(4)), delays.rank(Time::from_ns(7)));
    assert!((0..from - 2).chain(to + 2..TAPS).all(|tap| !taps.tap(tap)));
    assert!((from + 2..to - 2).all(|tap| taps.tap(tap)));
}

#[test]
fn however_many_transitions_there_are_taps_have_room_for_them() {
    let delays = delays();
    let (window, half_fs) = (Time::from_fs(32_000), 16_000);
    let [mut none, mut wide] =
        [Time::ZERO, window].map(|window| disturbance(window, 1, Pace::default()));
    let (mut transitions, mut now) = (Transitions::default(), Time::from_ns(100));
    for k in 0..20_000u64 {
        transitions.push(now + Time::from_fs(k * 104_729_000 % 1_900_000));
        now += Time::from_ns(2);
        let [taps, expected] = [&mut wide, &mut none]
            .map(|disturbance| disturbance.sample(k % 2 == 0, &transitions, now, &delays));
        // Every tap more than half a window from a transition is what it should be.
        let ages: Vec<_> = transitions.ages(now).collect();
        let near = |tap: usize| {
            let at = delays.boundary(tap).fs();
            ages.iter().any(|age| at.abs_diff(age.fs()) <= half_fs)
        };
        for tap in (0..TAPS).filter(|tap| !near(*tap)) {
            assert_eq!(taps.tap(tap), expected.tap(tap), "{k} {tap}");
        }
    }
}
