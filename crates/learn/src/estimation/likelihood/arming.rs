//! Which shots of MODE 1 find the diode armed, and what an old pulse in the chain makes of them.
//!
//! The diode fires at the rate a(t) = h(t) A(t): h is the hazard's rate and A(t) the chance that it is
//! armed, since an armed diode has no memory. What fires is back after the dead time D:
//! A'(t) = -a(t) + a(t - D). Shot after shot this comes to what repeats with the laser's period, and
//! that is computed step by step ([`super::steady`]).
//!
//! `tdc_stop` stays high for D, and the chain is longer than a clock period. An avalanche of a shot
//! is seen at its place only if the pulse before has left the chain by the first edge, so if the diode
//! came back at -L or before, L = chain - cycle. If it came back later, the old pulse is still in the
//! last taps, which are counted too: the avalanche seems earlier by as much as that was after -L. From
//! -tap_0 on (the delay of tap 0) tap 0 was high at the laser edge, and no hit is seen before the second
//! edge. What that one sees may seem as early as cycle - L; codes from there on have no cell.

use crate::estimation::acquisition::{Echo, FreeRunning};
use tofsim::kernel::pulse::Pulse;

use super::steady::Steady;

/// Detection of the avalanches of an armed shot.
#[derive(Clone, Debug)]
pub struct Arming {
    /// Chance that one is seen at its place [1].
    clean: f64,
    /// Chance that one is seen earlier by so many stretches, and a half [1].
    early: Vec<f64>,
}

impl Arming {
    /// For an echo that comes in every period; stretches are `stretch_ps` long.
    pub fn new(free: &FreeRunning, pulse: &Pulse, stretch_ps: f64, echo: &Echo) -> Self {
        let steady = Steady::new(free, pulse, echo);
        let empty_ps = free.empty_ps();
        let rate = echo.background_per_ps.max(0.0);
        let quiet = |before_ps: f64| libm::exp(-rate * before_ps);
        let count = ((empty_ps - free.tap_0_ps) / stretch_ps).round() as usize;
        let early = |k: usize| {
            let before_ps = empty_ps - (k as f64 + 0.5) * stretch_ps;
            steady.back_per_ps(before_ps) * stretch_ps * quiet(before_ps)
        };
        Arming {
            clean: steady.armed(empty_ps) * quiet(empty_ps),
            early: (0..count).map(early).collect(),
        }
    }

    /// Returns the distribution of the first avalanches of armed shots as they are detected; those that are not
    /// detected are missing.
    pub fn show(&self, first: &[f64]) -> Vec<f64> {
        let seen = |place: usize| {
            let early = self.early.iter().zip(&first[place..]);
            self.clean * first[place] + early.map(|(chance, p)| chance * p).sum::<f64>()
        };
        (0..first.len()).map(seen).collect()
    }
}
