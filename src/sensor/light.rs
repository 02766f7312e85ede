//! Source of avalanches: simulated optics, of all SPADs together or of each by itself, a photon list, or none.

use crate::kernel::Time;
use crate::optics::hazard::Cause;

pub use super::optics::Optics;

use super::photon_list::Given;
use super::row_light::RowLight;

/// Light that reaches the detector.
#[derive(Clone, Debug)]
pub enum Light {
    /// Laser, ambient light and dark counts.
    Optics(Box<Optics>),
    /// A photon list.
    List(Given),
    /// No avalanches at all.
    None,
    /// Laser, ambient light and dark counts of each SPAD of a row.
    Row(Box<RowLight>),
}

impl Light {
    /// Begins a frame; its random streams start with the next shot.
    pub fn begin_frame(&mut self, frame: u64) {
        match self {
            Light::Optics(optics) => optics.begin_frame(frame),
            Light::Row(row) => row.begin_frame(frame),
            Light::List(_) | Light::None => {}
        }
    }

    /// Begins a shot at `now`, with or without a laser pulse.
    #[inline(always)]
    pub fn begin_shot(&mut self, now: Time, laser: bool) {
        match self {
            Light::Optics(optics) => optics.begin_shot(now, laser),
            Light::List(given) => given.begin_shot(now),
            Light::None => {}
            Light::Row(row) => row.begin_shot(now, laser),
        }
    }

    /// Draws the time of the first avalanche, after `now`, among the SPADs that are armed: one in `share` of all [1].
    #[inline(always)]
    pub fn next_avalanche(&mut self, now: Time, share: f64) -> Time {
        match self {
            Light::Optics(optics) => optics.next_avalanche(now, share),
            Light::List(given) => given.next_photon(now),
            Light::None => Time::NEVER,
            Light::Row(row) => row.next_avalanche(now),
        }
    }

    /// Consumes the avalanche at `at`.
    pub fn take(&mut self, at: Time) {
        match self {
            Light::Optics(optics) => optics.take(at),
            Light::List(given) => {
                given.next_photon(at.saturating_add(Time::from_fs(1)));
            }
            Light::None => {}
            Light::Row(row) => row.take(at),
        }
    }

    /// Returns the SPAD of the carrier consumed last, where each has light of its own.
    pub fn spad(&self) -> Option<usize> {
        match self {
            Light::Row(row) => Some(row.last()),
            Light::Optics(_) | Light::List(_) | Light::None => None,
        }
    }

    /// Returns the fraction of the avalanche rate at `at` that is dark counts [1].
    pub fn dark_part(&self, at: Time) -> f64 {
        match self {
            Light::Optics(optics) => optics.dark_part(at),
            Light::Row(row) => row.dark_part(at),
            Light::List(_) | Light::None => 0.0,
        }
    }

    /// Returns the number of listed photons in shots that have not begun.
    pub fn left(&self) -> usize {
        match self {
            Light::List(given) => given.left(),
            Light::Optics(_) | Light::None | Light::Row(_) => 0,
        }
    }

    /// Returns whether the scene can change during the run.
    pub fn can_change(&self) -> bool {
        matches!(self, Light::Optics(_) | Light::Row(_))
    }

    /// Replaces the hazards by those of another scene, from the next draw on. The random streams continue.
    pub fn change(&mut self, other: &Light) {
        match (self, other) {
            (Light::Optics(own), Light::Optics(other)) => own.change(other),
            (Light::Row(own), Light::Row(other)) => own.change(other),
            _ => {}
        }
    }

    /// Draws the cause of the avalanche at `at` in the present shot. `dark` is the dark fraction of the rate of the
    /// SPAD that fired, if SPADs differ. Returns `None` for listed photons.
    pub fn cause(&mut self, at: Time, dark: Option<f64>) -> Option<Cause> {
        match self {
            Light::Optics(optics) => Some(optics.cause(at, dark)),
            Light::Row(row) => Some(row.cause(at)),
            Light::List(_) | Light::None => None,
        }
    }
}

#[cfg(test)]
mod tests;
