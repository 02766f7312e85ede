//! A diode by itself, free running (MODE 1) in constant light: what it counts, as a laboratory would measure it.
//!
//! It is the diode of a run ([`Spads`]) in the light of a run ([`Light`]), without firmware. Numbers come as means of
//! batches, each with random numbers of its own, so that their scatter is the standard error.

use serde::Serialize;

use crate::kernel::Time;
use crate::optics::{Budget, Hazard};
use crate::sensor::light::{Light, Optics};
use crate::sensor::row::Effects;
use crate::sensor::spad::{Event, Spads};

use super::setup::{Setup, effects};

pub mod afterpulses;
pub mod dark;
pub mod rates;

/// Batches of a measurement.
pub const BATCHES: u64 = 50;

/// A mean and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The mean.
    pub value: f64,
    /// Its standard error, in the same unit.
    pub se: f64,
}

impl Measured {
    /// Of what each batch gives.
    fn of(batches: &[f64]) -> Self {
        let count = batches.len() as f64;
        let value = batches.iter().sum::<f64>() / count;
        let squares: f64 = batches.iter().map(|batch| (batch - value).powi(2)).sum();
        Measured { value, se: (squares / (count * (count - 1.0))).sqrt() }
    }

    /// Returns the difference from the expected value [standard errors].
    pub fn deviations_from(&self, expected: f64) -> f64 {
        (self.value - expected) / self.se
    }
}

/// A diode and the dark that it has.
#[derive(Clone, Debug)]
pub struct FreeRunning {
    dead_time: Time,
    effects: Effects,
    seed: u64,
}

impl FreeRunning {
    /// One diode of a scenario's row, and nothing of its neighbours.
    pub fn new(setup: &Setup) -> Self {
        let spad = &setup.scenario.spad;
        FreeRunning {
            dead_time: Time::from_ps_f64(spad.dead_time_ns * 1e3),
            effects: Effects {
                dark_rates: Vec::new(),
                crosstalk_probability: 0.0,
                ..effects(spad, &setup.dark)
            },
            seed: setup.scenario.seed,
        }
    }

    /// The same without afterpulses, and with that dead time.
    pub fn without_afterpulses(&self, paralysable: bool) -> Self {
        let effects = Effects { trap_probability: 0.0, paralysable, ..self.effects.clone() };
        FreeRunning { effects, ..self.clone() }
    }

    /// Dead time [s].
    pub fn dead_time_s(&self) -> f64 {
        self.dead_time.seconds()
    }

    /// Shows when it fires until a time, at such rates of photons and in the dark [1/s], with the random numbers of
    /// `run`.
    fn counts(&self, rates_hz: [f64; 2], run: u64, until: Time, mut take: impl FnMut(Time)) {
        let [ambient_rate_hz, dark_rate_hz] = rates_hz;
        let budget = Budget { ambient_rate_hz, dark_rate_hz, ..Budget::default() };
        let hazard = Hazard::dark(&budget);
        let mut light = Light::Optics(Box::new(Optics::new(hazard.clone(), hazard, self.seed)));
        light.begin_frame(run);
        let mut diode = Spads::new(1, self.dead_time, Time::NEVER)
            .with_effects(self.effects.clone(), self.seed);
        if let Some(row) = diode.row() {
            row.begin_frame(run);
        }
        diode.set_passive(true, Time::ZERO);
        diode.arm_all(light.next_avalanche(Time::ZERO, 1.0));
        while diode.next_event() <= until {
            let now = diode.next_event();
            if let Event::Avalanche | Event::Afterpulse = diode.event(&mut light) {
                take(now);
            }
            if diode.waits() {
                diode.arm(light.next_avalanche(now, diode.share()));
            }
        }
    }
}
