//! Laser light that the cover window sends back to the detector: how much, and when.
//!
//! The window sends a fraction of the pulse energy to the lens, which filter, lens and SPADs treat as they do an echo.
//! Its delay after the light that leaves the laser is normal, and a part of it has an exponential delay on top; it
//! comes with the laser's pulse, so that its density is the convolution of all three.

use crate::kernel::pulse::Pulse;
use crate::scenario::{Cover, Scenario};

use super::photometry::whole_pulse_per_shot;

/// Reach of a normal delay, beyond which 1e-15 of it is left [standard deviations].
const NORMAL_REACH: f64 = 8.0;
/// Reach of an exponential delay, beyond which 1e-7 of it is left [time constants].
const SMEAR_REACH: f64 = 16.0;
/// Femtoseconds of a picosecond.
const FS_PER_PS: f64 = 1e3;

/// Distribution of the delays of the window's light, without the pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delays {
    /// Mean delay of the light that is not smeared [fs].
    pub at_fs: f64,
    /// Standard deviation of the normal delay [fs].
    width_fs: f64,
    /// Fraction that is smeared [1].
    smeared: f64,
    /// Mean of the exponential delay [fs].
    smear_fs: f64,
}

impl Delays {
    /// Returns the delays of a scenario's window; `None` if there is no window.
    pub fn of(cover: &Cover) -> Option<Self> {
        let &Cover { delay_ps, width_ps, smear_fraction: smeared, smear_ps, .. } = cover;
        let [at_fs, width_fs, smear_fs] = [delay_ps, width_ps, smear_ps].map(|ps| ps * FS_PER_PS);
        cover.is_there().then_some(Delays { at_fs, width_fs, smeared, smear_fs })
    }

    /// Returns the begin and the end of the delays [fs].
    pub fn reach_fs(&self) -> [f64; 2] {
        let half = NORMAL_REACH * self.width_fs;
        let smear = if self.smeared > 0.0 { SMEAR_REACH * self.smear_fs } else { 0.0 };
        [self.at_fs - half, self.at_fs + half + smear]
    }

    /// Returns the part of the light that has the mean delay exactly [1].
    pub fn exact(&self) -> f64 {
        if self.width_fs == 0.0 { 1.0 - self.smeared } else { 0.0 }
    }

    /// Returns the part of all light that is spread over a range of delays and whose delay is less than `fs` [1].
    pub fn spread_before(&self, fs: f64) -> f64 {
        let (since, smeared) = (fs - self.at_fs, self.smeared);
        if self.width_fs == 0.0 {
            return -smeared * libm::expm1(-(since / self.smear_fs).max(0.0));
        }
        let part = |tail_ps: f64| {
            let pulse = Pulse::tailed(self.width_fs / FS_PER_PS, tail_ps);
            pulse.part(since / FS_PER_PS - tail_ps)
        };
        let mut sum = (1.0 - smeared) * part(0.0);
        if smeared > 0.0 {
            sum += smeared * part(self.smear_fs / FS_PER_PS);
        }
        sum
    }
}

/// Returns the mean number of detected photons per shot that the window sends to a pixel, of the solid angle `share` of
/// the field of view, and with a fraction of its own if it has one [1].
pub fn per_shot(scenario: &Scenario, share: f64, own: Option<f64>) -> f64 {
    let cover = &scenario.cover;
    let factor = cover.temperature_factor(scenario.spad.temperature_c);
    let fraction = own.unwrap_or(cover.fraction * share) * factor + cover.dirt() * share;
    fraction * f64::from(scenario.spad.on_tdc) * whole_pulse_per_shot(scenario)
}

#[cfg(test)]
mod tests;
