//! When the next avalanche comes: from optics, from a photon list, or never.
//!
//! Optics draws one time an avalanche from the cumulative hazard of the shot. A shot begins with
//! its laser edge; what an armed diode was waiting for is then drawn anew, which is exact, because
//! photons before and after an instant are independent.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::kernel::Time;
use crate::optics::hazard::{Cause, Hazard};

use super::photon_list::Given;
use super::streams::{Source, exponential, seek, stream, uniform};

/// What reaches the detector.
#[derive(Clone, Debug)]
pub enum Light {
    /// Laser, ambient light and dark counts.
    Optics(Box<Optics>),
    /// Given photons.
    List(Given),
    /// Nothing, ever.
    None,
}

impl Light {
    /// A new frame begins: its streams are taken up with the next shot.
    pub fn begin_frame(&mut self, frame: u64) {
        if let Light::Optics(optics) = self {
            optics.begin_frame(frame);
        }
    }

    /// A shot begins at `now`, with the laser or in the dark.
    #[inline(always)]
    pub fn begin_shot(&mut self, now: Time, laser: bool) {
        match self {
            Light::Optics(optics) => optics.begin_shot(now, laser),
            Light::List(given) => given.begin_shot(now),
            Light::None => {}
        }
    }

    /// The first avalanche of the diodes that are armed at `now`: one in `share` of all [1].
    #[inline(always)]
    pub fn next_avalanche(&mut self, now: Time, share: f64) -> Time {
        match self {
            Light::Optics(optics) => optics.next_avalanche(now, share),
            Light::List(given) => given.next_photon(now),
            Light::None => Time::NEVER,
        }
    }

    /// Given photons of shots that have not begun.
    pub fn left(&self) -> usize {
        match self {
            Light::List(given) => given.left(),
            Light::Optics(_) | Light::None => 0,
        }
    }

    /// What set off the avalanche at `at`, in the present shot; unknown for given photons.
    pub fn cause(&mut self, at: Time) -> Option<Cause> {
        match self {
            Light::Optics(optics) => Some(optics.cause(at)),
            Light::List(_) | Light::None => None,
        }
    }
}

/// Light by the link budget.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Hazard of a shot with the laser, and of one without.
    hazards: Arc<[Hazard; 2]>,
    seed: u64,
    first: ChaCha8Rng,
    further: ChaCha8Rng,
    causes: ChaCha8Rng,
    /// Whether the present shot has the laser.
    lit: bool,
    /// Begin of the present shot.
    origin: Time,
    /// Shots of this frame, the time before its first one counted as shot 0.
    shot: u64,
    /// Word of the shot's first avalanche, until used.
    word: Option<u64>,
    /// Further avalanches drawn in this shot, and causes.
    further_drawn: u64,
    causes_drawn: u64,
}

impl Optics {
    /// Light with those hazards of a lit and of a dark shot, before the first frame's first shot.
    pub fn new(lit: Hazard, dark: Hazard, seed: u64) -> Self {
        Optics {
            hazards: Arc::new([dark, lit]),
            seed,
            first: stream(seed, Source::Avalanche, 0),
            further: stream(seed, Source::FurtherAvalanches, 0),
            causes: stream(seed, Source::Cause, 0),
            lit: false,
            origin: Time::ZERO,
            shot: 0,
            word: None,
            further_drawn: 0,
            causes_drawn: 0,
        }
    }

    fn begin_frame(&mut self, frame: u64) {
        self.first = stream(self.seed, Source::Avalanche, frame);
        self.further = stream(self.seed, Source::FurtherAvalanches, frame);
        self.causes = stream(self.seed, Source::Cause, frame);
        (self.shot, self.further_drawn, self.causes_drawn) = (0, 0, 0);
    }

    #[inline(always)]
    fn begin_shot(&mut self, now: Time, laser: bool) {
        (self.origin, self.lit) = (now, laser);
        self.shot += 1;
        self.word = Some(self.first.next_u64());
        (self.further_drawn, self.causes_drawn) = (0, 0);
    }

    /// The hazard of a shot with the laser, or of one without.
    pub fn hazard(&self, lit: bool) -> &Hazard {
        &self.hazards[lit as usize]
    }

    /// Passes over `shots` shots that have one avalanche at most each: shows the words that draw
    /// them.
    #[inline]
    pub fn pass(&mut self, shots: u64, mut take: impl FnMut(u64)) {
        (0..shots).for_each(|_| take(self.first.next_u64()));
        self.shot += shots;
    }

    #[inline(always)]
    fn next_avalanche(&mut self, now: Time, share: f64) -> Time {
        let word = match self.word.take() {
            Some(word) => word,
            None => self.further_word(),
        };
        let hazard = &self.hazards[self.lit as usize];
        let reached = hazard.at(now.since(self.origin)) + exponential(word) * share;
        self.origin.saturating_add(hazard.inverse(reached)).max(now)
    }

    #[cold]
    fn further_word(&mut self) -> u64 {
        if self.further_drawn == 0 {
            seek(&mut self.further, self.shot, 0);
        }
        self.further_drawn += 1;
        self.further.next_u64()
    }

    fn cause(&mut self, at: Time) -> Cause {
        seek(&mut self.causes, self.shot, self.causes_drawn);
        self.causes_drawn += 1;
        let hazard = &self.hazards[self.lit as usize];
        hazard.cause(at.since(self.origin), uniform(self.causes.next_u64()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::Budget;

    fn optics() -> Light {
        let ambient_rate_hz = 0.27e9;
        let mean_arrival = Time::from_ns(3);
        let budget = Budget {
            signal_per_shot: 0.9,
            ambient_rate_hz,
            mean_arrival,
            pulse_sigma_ps: 137.0,
            ..Budget::default()
        };
        Light::Optics(Box::new(Optics::new(Hazard::new(&budget), Hazard::dark(&budget), 1)))
    }

    /// First avalanches of ten shots, with `more` further ones drawn in each, and causes or not.
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
                light.cause(first);
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

    /// Times from re-arming, 20 ns into a shot, to the next avalanche [ns].
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
            light.cause(begun + Time::from_fs(3_300_000))
        };
        let causes: Vec<_> = (0..200).map(at_peak).collect();
        for cause in [Cause::Signal, Cause::Ambient] {
            assert!(causes.iter().filter(|&&found| found == Some(cause)).count() > 5, "{cause:?}");
        }
    }
}
