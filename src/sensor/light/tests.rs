//! Tests that unused draws have no effect, and that waiting times match the rates.

use super::*;
use crate::optics::{Budget, Hazard};

fn optics() -> Light {
    let ambient_rate_hz = 0.27e9;
    let mean_arrival = Time::from_ns(3);
    let budget =
        Budget { signal_per_shot: 0.9, ambient_rate_hz, mean_arrival, ..Budget::default() };
    Light::Optics(Box::new(Optics::new(Hazard::new(&budget), Hazard::dark(&budget), 1)))
}

/// Returns the first avalanches of ten shots, with `more` further avalanches drawn in each, and optionally causes.
fn first_avalanches(more: usize, causes: bool) -> Vec<Time> {
    let mut light = optics();
    light.begin_frame(3);
    let shot = |shot: u64| {
        let begun = Time::from_ns(48 * shot);
        light.begin_shot(begun, true);
        let first = light.next_avalanche(begun, 1.0);
        for _ in 0..more {
            assert!(light.next_avalanche(begun + Time::from_ns(20), 1.0) > begun);
        }
        if causes {
            light.cause(first, None);
        }
        first
    };
    (0..10).map(shot).collect()
}

#[test]
fn further_avalanches_and_causes_do_not_move_the_first_ones_of_later_shots() {
    let alone = first_avalanches(0, false);
    assert_eq!(first_avalanches(5, false), alone);
    assert_eq!(first_avalanches(0, true), alone);
}

#[test]
fn further_avalanches_depend_on_the_shot_alone() {
    let further = |skipped: u64| {
        let mut light = optics();
        for shot in 0..5 {
            light.begin_shot(Time::from_ns(48 * shot), true);
            light.next_avalanche(Time::from_ns(48 * shot), 1.0);
            if shot >= skipped {
                light.next_avalanche(Time::from_ns(48 * shot + 20), 1.0);
            }
        }
        light.next_avalanche(Time::from_ns(48 * 4 + 40), 1.0)
    };
    assert_eq!(further(0), further(4));
}

/// Returns the times from rearming, 20 ns into a shot, to the next avalanche [ns].
fn waits_after_dead_time(shots: u64) -> Vec<f64> {
    let mut light = optics();
    let wait = |shot: u64| {
        let begun = Time::from_ns(1000 * shot);
        light.begin_shot(begun, true);
        light.next_avalanche(begun, 1.0);
        let armed = begun + Time::from_ns(20);
        (light.next_avalanche(armed, 1.0) - armed).seconds() * 1e9
    };
    (0..shots).map(wait).collect()
}

#[test]
fn an_avalanche_after_the_dead_time_waits_for_ambient_light_alone() {
    let waits = waits_after_dead_time(20_000);
    let mean_ns = waits.iter().sum::<f64>() / waits.len() as f64;
    let expected_ns = 1.0 / 0.27;
    assert!((mean_ns / expected_ns - 1.0).abs() < 4.0 / 141.0, "{mean_ns} ns");
    let late = waits.iter().filter(|&&wait| wait > expected_ns).count() as f64 / 20_000.0;
    assert!((late - (-1.0f64).exp()).abs() < 4.0 * 0.0034, "{late}");
}

#[test]
fn further_avalanches_differ_from_shot_to_shot() {
    let mut waits = waits_after_dead_time(100);
    waits.sort_by(f64::total_cmp);
    waits.dedup();
    assert_eq!(waits.len(), 100);
}

#[test]
fn causes_differ_from_shot_to_shot() {
    let mut light = optics();
    let at_peak = |shot: u64| {
        let begun = Time::from_ns(1000 * shot);
        light.begin_shot(begun, true);
        light.cause(begun + Time::from_fs(3_300_000), None)
    };
    let causes: Vec<_> = (0..200).map(at_peak).collect();
    for cause in [Cause::Signal, Cause::Ambient] {
        assert!(causes.iter().filter(|&&found| found == Some(cause)).count() > 5, "{cause:?}");
    }
}
