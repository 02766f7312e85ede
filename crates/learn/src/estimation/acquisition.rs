//! How histograms come about, as far as estimators know it.

use tofsim::error::Input;
use tofsim::kernel::Time;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::optics::{Bins, Budget};

/// Width of a bin as the decoder's codes count it [ps].
pub const BIN_PS: f64 = 25.0;
/// Mean arrival of an echo for each metre of distance, 2 / c (eq. 3.23) [ps/m].
pub const ARRIVAL_PS_PER_M: f64 = 2e12 / LIGHT_M_S;

/// How the histograms come about, as far as estimators know it.
#[derive(Clone, Copy, Debug)]
pub struct Acquisition<'a> {
    /// Which avalanche times give which code.
    pub bins: &'a Bins,
    /// Shots of a histogram, or of a dark and a lit one together [shots].
    pub shots: u64,
    /// Standard deviation of the pulse as the detector times it [ps].
    pub pulse_sigma_ps: f64,
}

impl Acquisition<'_> {
    /// Whether there is anything to estimate from.
    ///
    /// # Errors
    /// For no bins, no shots or more than a bin of 16 bits holds, or a width that is no width.
    pub fn check(&self) -> Result<(), Input> {
        let fault = |field, expected| Input::new("acquisition", expected).field(field);
        if self.bins.spans().is_empty() {
            return Err(fault("bins", "expected a chain that gives a code at all"));
        }
        if !(1..=65_535).contains(&self.shots) {
            return Err(fault("shots", "expected 1 to 65535").value(self.shots));
        }
        if !(1.0..=1e6).contains(&self.pulse_sigma_ps) {
            let value = self.pulse_sigma_ps;
            return Err(fault("pulse_sigma_ps", "expected 1 to 1e6 [ps]").value(value));
        }
        Ok(())
    }
}

/// What a histogram depends on: the echo of the target, and the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Echo {
    /// Mean arrival of the echo [ps].
    pub arrival_ps: f64,
    /// Detected laser photons per shot, S_p [1].
    pub signal: f64,
    /// Rate of other avalanches, N_r and dark ones [1/ps].
    pub background_per_ps: f64,
}

impl From<&Budget> for Echo {
    fn from(budget: &Budget) -> Self {
        Echo {
            arrival_ps: budget.mean_arrival.fs() as f64 * 1e-3,
            signal: budget.signal_per_shot,
            background_per_ps: budget.background_rate_hz() * 1e-12,
        }
    }
}

/// Code, begin and end of each stretch of time that has a code, in order of time [code, ps, ps].
pub fn spans_ps(bins: &Bins) -> impl Iterator<Item = (u8, f64, f64)> {
    let ps = |time: Time| time.fs() as f64 * 1e-3;
    bins.spans().iter().map(move |span| (span.code, ps(span.from), ps(span.until)))
}
