use super::*;
use crate::optics::{Budget, Hazard};
use crate::sensor::light::Optics;

const DEAD: Time = Time::from_ns(20);

fn one() -> Spads {
    Spads::new(1, DEAD, Time::from_ns(5))
}

#[test]
fn in_mode_0_the_output_stays_high_until_the_reset() {
    for count in [1, 40] {
        let mut spads = Spads::new(count, DEAD, Time::from_ns(5));
        assert_eq!(spads.event(&mut Light::None), Event::Avalanche);
        assert!(spads.output() && !spads.is_armed());
        assert_eq!(spads.next_event(), Time::NEVER);
        spads.hold();
        assert!(spads.is_off() && !spads.output() && !spads.is_armed());
        spads.arm_all(Time::from_ns(70));
        assert!(spads.is_armed() && !spads.waits());
        assert_eq!(spads.next_event(), Time::from_ns(70));
    }
}

#[test]
fn in_mode_1_it_recovers_after_the_dead_time() {
    let mut spad = one();
    spad.set_passive(true, Time::ZERO);
    spad.event(&mut Light::None);
    assert!(!spad.is_armed());
    assert_eq!(spad.next_event(), Time::from_ns(25));
    assert_eq!(spad.event(&mut Light::None), Event::Recovery);
    assert!(spad.waits());
    spad.arm(Time::from_ns(40));
    assert_eq!(spad.next_event(), Time::from_ns(40));
}

#[test]
fn in_mode_1_the_others_stay_armed_and_the_last_to_recover_ends_the_output() {
    let mut spads = Spads::new(3, DEAD, Time::from_ns(5));
    spads.set_passive(true, Time::ZERO);
    for (at, share) in [(5, 1.5), (9, 3.0)] {
        assert_eq!(spads.next_event(), Time::from_ns(at));
        assert_eq!(spads.event(&mut Light::None), Event::Avalanche);
        assert!(spads.waits());
        assert_eq!(spads.share(), share);
        spads.arm(Time::from_ns(9 + 100 * u64::from(at == 9)));
    }
    for (at, output) in [(25, true), (29, false)] {
        assert_eq!(spads.next_event(), Time::from_ns(at));
        assert_eq!(spads.event(&mut Light::None), Event::Recovery);
        assert_eq!(spads.output(), output);
        spads.arm(Time::from_ns(109));
    }
    assert_eq!(spads.next_event(), Time::from_ns(109));
}

/// A SPAD that traps a carrier for 50 ns in nearly every avalanche, with an avalanche at 5 ns.
fn trapping(paralysable: bool) -> Spads {
    let (trap_probability, afterpulse_fs) = (1.0 - 1e-9, 5e7);
    let effects = Effects { trap_probability, afterpulse_fs, paralysable, ..Effects::default() };
    let mut spads = one().with_effects(effects, 1);
    assert_eq!(spads.event(&mut Light::None), Event::Avalanche);
    spads
}

fn release(spads: &mut Spads) -> Time {
    spads.row().map_or(Time::NEVER, |row| row.release())
}

#[test]
fn in_mode_0_an_afterpulse_reaches_the_next_shot_only_after_its_reset_has_fallen() {
    for (reset_falls_later, expected) in [(0, Event::Afterpulse), (1, Event::Unseen)] {
        let mut spads = trapping(false);
        let release = release(&mut spads);
        assert_eq!(spads.next_event(), release);
        spads.hold();
        assert!(!spads.output() && spads.next_event() == release);
        let falls = release + Time::from_fs(reset_falls_later);
        if falls <= release {
            spads.arm_all(Time::NEVER);
        }
        assert_eq!(spads.event(&mut Light::None), expected);
        assert_eq!(spads.output(), expected == Event::Afterpulse);
        if falls > release {
            spads.arm_all(Time::NEVER);
            assert_eq!((spads.output(), spads.next_event()), (false, Time::NEVER));
        }
    }
}

#[test]
fn in_mode_0_a_carrier_released_before_the_reset_is_lost() {
    let mut spads = trapping(false);
    assert!(spads.output());
    assert_eq!(spads.event(&mut Light::None), Event::Unseen);
    assert!(spads.output() && spads.next_event() == Time::NEVER);
}

#[test]
fn in_mode_1_a_carrier_released_within_the_dead_time_is_lost_or_starts_it_again() {
    for paralysable in [false, true] {
        let mut spads = trapping(paralysable);
        spads.set_passive(true, Time::from_ns(5));
        let release = release(&mut spads);
        if let Some(row) = spads.row() {
            row.not_before(release + Time::from_ns(1));
        }
        spads.fired[0] = release + Time::from_ns(1);
        spads.arm(Time::NEVER);
        assert_eq!((spads.next_event(), spads.is_armed()), (release, paralysable));
        assert_eq!(spads.event(&mut Light::None), Event::Unseen);
        let until = release + if paralysable { DEAD } else { Time::from_ns(1) };
        assert_eq!(spads.next_event(), until);
        assert_eq!(spads.event(&mut Light::None), Event::Recovery);
        assert!(!spads.output() && spads.waits());
    }
}

#[test]
fn diodes_that_only_fire_are_not_told_apart() {
    let effects = Effects { crosstalk_probability: 0.5, ..Effects::default() };
    assert!(one().with_effects(effects.clone(), 1).row().is_none());
    assert!(Spads::new(2, DEAD, Time::ZERO).with_effects(effects, 1).row().is_some());
    assert!(Spads::new(2, DEAD, Time::ZERO).with_effects(Effects::default(), 1).row().is_none());
}

#[test]
fn a_change_of_mode_finds_a_diode_that_has_fired() {
    let mut spad = one();
    spad.event(&mut Light::None);
    spad.set_passive(true, Time::from_ns(10));
    assert_eq!(spad.next_event(), Time::from_ns(25));
    spad.set_passive(false, Time::from_ns(12));
    assert_eq!(spad.next_event(), Time::NEVER);
    spad.set_passive(true, Time::from_ns(90));
    assert_eq!(spad.next_event(), Time::from_ns(90));
}

/// Two SPADs, of which the second is connected to the TDC, with an avalanche in the first at 5 ns.
fn one_of_two(crosstalk_probability: f64) -> Spads {
    let effects = Effects {
        on_tdc: Some(1..2),
        crosstalk_probability,
        dark_rates: vec![1.0, 0.0],
        ..Effects::default()
    };
    Spads::new(2, DEAD, Time::from_ns(5)).with_effects(effects, 1)
}

/// Light that consists of dark counts only.
fn dark() -> Light {
    let budget = Budget { dark_rate_hz: 1e8, ..Budget::default() };
    let hazard = Hazard::dark(&budget);
    let mut light = Light::Optics(Box::new(Optics::new(hazard.clone(), hazard, 1)));
    light.begin_shot(Time::ZERO, false);
    light
}

#[test]
fn in_mode_0_a_diode_that_is_not_on_the_tdc_fires_unseen_and_the_others_stay_armed() {
    let (mut spads, mut light) = (one_of_two(0.0), dark());
    assert_eq!(spads.event(&mut light), Event::Unseen);
    assert_eq!((spads.output(), spads.outputs()), (false, 0b01));
    assert!(spads.is_armed() && spads.waits());
    assert_eq!(spads.next_event(), Time::NEVER);
    spads.hold();
    assert_eq!((spads.output(), spads.outputs()), (false, 0));
    spads.arm_all(Time::from_ns(70));
    assert_eq!(spads.next_event(), Time::from_ns(70));
}

#[test]
fn a_diode_that_is_not_on_the_tdc_sets_off_one_that_is() {
    let (mut spads, mut light) = (one_of_two(1.0), dark());
    assert_eq!(spads.event(&mut light), Event::Avalanche);
    assert_eq!((spads.output(), spads.outputs()), (true, 0b11));
    assert_eq!(spads.dark_part(), Some(1.0));
    assert!(!spads.is_armed());
    spads.set_passive(true, Time::from_ns(6));
    assert_eq!(spads.next_event(), Time::from_ns(25));
    assert_eq!(spads.event(&mut light), Event::Recovery);
    assert_eq!((spads.output(), spads.outputs()), (false, 0));
}
