//! The laser period that repeats: when the diode is armed, and when it comes back.
//!
//! The chances of a period are a linear map of those of the period before. A diode that fires again and again,
//! each dead time and a little, remembers the laser's phase for thousands of periods, so that what repeats is
//! solved for, by generalised conjugate residuals (Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20,
//! 1983), in some ten periods.
//!
//! Because all of it repeats, a dead time shorter by whole periods has the same solution but for a factor. The
//! factor follows from the diode being either armed or dead.

use tofsim::kernel::pulse::Pulse;

use crate::estimation::acquisition::{Echo, FreeRunning};

/// Longest step [ps].
const STEP_PS: f64 = 25.0;
/// States repeat if they differ by less (root of the sum of squares) [1].
const SAME: f64 = 1e-10;
/// Most directions of the solver.
const MOST_DIRECTIONS: usize = 100;

/// The laser period that repeats, by steps.
pub struct Steady {
    step_ps: f64,
    /// Chance that the diode is armed as a step begins [1].
    armed: Vec<f64>,
    /// Chance that it comes back in a step [1].
    back: Vec<f64>,
}

/// A laser period.
struct Period {
    /// For each step, the chance that an armed diode fires [1].
    fires: Vec<f64>,
    /// Whole steps of the dead time, one at least, and the part of a step that is left [1].
    dead: (usize, f64),
}

/// What a period leaves to the next: how often the diode fired in each of the steps from which it is not back
/// yet, and last how often it is armed.
type State = Vec<f64>;

impl Steady {
    /// For an echo that comes in every period.
    pub fn new(free: &FreeRunning, pulse: &Pulse, echo: &Echo) -> Self {
        let count = (free.period_ps / STEP_PS).ceil() as usize;
        let step_ps = free.period_ps / count as f64;
        let hazard = |k: usize| {
            let t_ps = k as f64 * step_ps;
            let signal = if k == 0 { 0.0 } else { pulse.part(t_ps - echo.arrival_ps) };
            echo.background_per_ps.max(0.0) * t_ps + echo.signal * signal
        };
        let hazards: Vec<_> = (0..=count).map(hazard).collect();
        if hazards[count] <= 0.0 {
            return Steady { step_ps, armed: vec![1.0; count], back: vec![0.0; count] };
        }
        let fires = hazards.windows(2).map(|pair| -libm::expm1(pair[0] - pair[1]));
        let dead = (free.dead_ps / step_ps).max(1.0);
        let within = (dead - 1.0) % count as f64 + 1.0;
        let period = Period { fires: fires.collect(), dead: (within as usize, within.fract()) };
        // The solver begins as if photons came evenly, which is near to what repeats.
        let mut state = vec![hazards[count] / count as f64; within as usize + 1];
        state.push(1.0);
        let state = period.repeating(state);

        let (mut armed, mut back) = (Vec::with_capacity(count), Vec::with_capacity(count));
        period.pass(&state, |step_armed, step_back| {
            armed.push(step_armed);
            back.push(step_back);
        });
        // The chances that it is armed and that it is dead, which have to be 1.
        let sum = |parts: &[f64]| parts.iter().sum::<f64>();
        let whole = (sum(&armed) + dead * sum(&back)) / count as f64;
        [&mut armed, &mut back].into_iter().flatten().for_each(|value| *value /= whole);
        Steady { step_ps, armed, back }
    }

    /// The step that holds a time before the laser edge, and how far into it that is [1].
    fn place(&self, before_ps: f64) -> (usize, f64) {
        let place = (self.armed.len() as f64 - before_ps / self.step_ps).max(0.0);
        ((place as usize).min(self.armed.len() - 1), place.fract())
    }

    /// Returns the chance that the diode is armed at a time before the laser edge [1].
    pub fn armed(&self, before_ps: f64) -> f64 {
        let (step, part) = self.place(before_ps);
        let next = self.armed[(step + 1) % self.armed.len()];
        self.armed[step] * (1.0 - part) + next * part
    }

    /// Returns the rate at which it comes back there [1/ps].
    pub fn back_per_ps(&self, before_ps: f64) -> f64 {
        self.back[self.place(before_ps).0] / self.step_ps
    }
}

impl Period {
    /// Returns the state that a period turns a state into, and shows for each step how often the diode is armed and
    /// how often it comes back.
    fn pass(&self, state: &[f64], mut show: impl FnMut(f64, f64)) -> State {
        let (whole, part) = self.dead;
        let (window, steps) = (whole + 1, self.fires.len());
        let mut fired = vec![0.0; window + steps];
        fired[..window].copy_from_slice(&state[..window]);
        let mut armed = state[window];
        // What fires in a dead time is not back in it.
        for (start, fires) in (0..steps).step_by(whole).zip(self.fires.chunks(whole)) {
            let (before, now) = fired[start..].split_at_mut(window);
            for ((pair, fires), fired) in before.windows(2).zip(fires).zip(now) {
                let back = (1.0 - part) * pair[1] + part * pair[0];
                show(armed, back);
                *fired = armed * fires;
                armed = armed * (1.0 - fires) + back;
            }
        }
        fired.drain(..steps);
        fired.push(armed);
        fired
    }

    /// Returns the state that repeats, from one near it.
    fn repeating(&self, mut state: State) -> State {
        let mut residual = self.change(&state);
        // Directions, and the changes of the residual that they bring: orthogonal, of length 1.
        let mut directions: Vec<(State, State)> = Vec::new();
        while dot(&residual, &residual).sqrt() > SAME && directions.len() < MOST_DIRECTIONS {
            let mut step = residual.clone();
            let mut gain = self.change(&step);
            for (earlier, its_gain) in &directions {
                let common = dot(&gain, its_gain);
                add(&mut gain, -common, its_gain);
                add(&mut step, -common, earlier);
            }
            let length = dot(&gain, &gain).sqrt();
            if length == 0.0 {
                break;
            }
            [&mut step, &mut gain].into_iter().flatten().for_each(|value| *value /= length);
            let by = -dot(&residual, &gain);
            add(&mut state, by, &step);
            add(&mut residual, by, &gain);
            directions.push((step, gain));
        }
        state
    }

    /// Difference that a period makes.
    fn change(&self, state: &[f64]) -> State {
        let mut after = self.pass(state, |_, _| ());
        add(&mut after, -1.0, state);
        after
    }
}

/// Sums that a dot product is made of, for the processor to form side by side.
const LANES: usize = 8;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Adds a multiple of a vector to another.
fn add(to: &mut [f64], by: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(to, what)| *to += by * what);
}

#[cfg(test)]
mod tests;
