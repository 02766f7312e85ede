//! Which shots of MODE 1 find the diode armed, and what an old pulse in the chain makes of them.
//!
//! The diode fires at the rate a(t) = h(t) A(t): h is the hazard's rate and A(t) the chance that it is
//! armed, since an armed diode has no memory. What fires is back after the dead time D:
//! A'(t) = -a(t) + a(t - D). Shot after shot this comes to what repeats with the laser's period, and
//! that is computed here, step by step, for a diode that has seen even light before.
//!
//! `tdc_stop` stays high for D, and the chain is longer than a clock period. An avalanche of a shot
//! is seen at its place only if the pulse before has left the chain by the first edge, so if the diode
//! came back at -L or before, L = chain - cycle. If it came back later, the old pulse is still in the
//! last taps, which are counted too: the avalanche seems earlier by as much as that was after -L. From
//! -tap_0 on (the delay of tap 0) tap 0 was high at the laser edge, and no hit is seen before the second
//! edge. What that one sees may seem as early as cycle - L; codes from there on have no cell.

use crate::estimation::acquisition::{Echo, FreeRunning};
use tofsim::kernel::pulse::Pulse;

/// Longest step [ps].
const STEP_PS: f64 = 25.0;
/// A chance that has changed by less from one period to the next repeats [1].
const SAME: f64 = 1e-8;
/// Most steps until it does.
const MOST_STEPS: usize = 100_000;

/// Detection of the avalanches of an armed shot.
#[derive(Clone, Debug)]
pub struct Arming {
    /// Chance that one is seen at its place [1].
    clean: f64,
    /// Chance that one is seen earlier by so many stretches, and a half [1].
    early: Vec<f64>,
}

/// A period that repeats, by steps.
struct Steady {
    step_ps: f64,
    /// Chance that the diode is armed as a step begins [1].
    armed: Vec<f64>,
    /// Chance that it comes back in a step [1].
    back: Vec<f64>,
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

impl Steady {
    fn new(free: &FreeRunning, pulse: &Pulse, echo: &Echo) -> Self {
        let count = (free.period_ps / STEP_PS).ceil() as usize;
        let step_ps = free.period_ps / count as f64;
        let hazard = |k: usize| {
            let t_ps = k as f64 * step_ps;
            let signal = if k == 0 { 0.0 } else { pulse.part(t_ps - echo.arrival_ps) };
            echo.background_per_ps.max(0.0) * t_ps + echo.signal * signal
        };
        let hazards: Vec<_> = (0..=count).map(hazard).collect();
        let fires: Vec<_> =
            hazards.windows(2).map(|pair| -libm::expm1(pair[0] - pair[1])).collect();
        let dead = (free.dead_ps / step_ps).max(1.0);
        let (whole, part) = (dead.floor() as usize, dead.fract());
        // It begins as if photons came evenly, which is near to what repeats.
        let even = hazards[count] / free.period_ps;
        let fires_per_ps = even / (1.0 + even * free.dead_ps);
        // What fired in each step, from a dead time before the first one on.
        let mut fired = vec![fires_per_ps * step_ps; whole + 1];
        let mut armed = 1.0 - fires_per_ps * free.dead_ps;
        let mut steady = Steady { step_ps, armed: vec![1.0; count], back: vec![0.0; count] };
        // What fired in the first dead time has to be back before anything can repeat.
        let least = 2 * (whole + count);
        for period in 1.. {
            let mut changed: f64 = 0.0;
            for (k, fires) in fires.iter().enumerate() {
                let now = fired.len() - (whole + 1);
                let back = (1.0 - part) * fired[now + 1] + part * fired[now];
                changed = changed.max((armed - steady.armed[k]).abs());
                (steady.armed[k], steady.back[k]) = (armed, back);
                let fires = armed * fires;
                fired.push(fires);
                armed += back - fires;
            }
            let steps = period * count;
            if (changed < SAME && steps > least) || steps > MOST_STEPS {
                break;
            }
        }
        steady
    }

    /// The step that holds a time before the laser edge, and how far into it that is [1].
    fn place(&self, before_ps: f64) -> (usize, f64) {
        let place = (self.armed.len() as f64 - before_ps / self.step_ps).max(0.0);
        ((place as usize).min(self.armed.len() - 1), place.fract())
    }

    fn armed(&self, before_ps: f64) -> f64 {
        let (step, part) = self.place(before_ps);
        let next = self.armed[(step + 1) % self.armed.len()];
        self.armed[step] * (1.0 - part) + next * part
    }

    fn back_per_ps(&self, before_ps: f64) -> f64 {
        self.back[self.place(before_ps).0] / self.step_ps
    }
}
