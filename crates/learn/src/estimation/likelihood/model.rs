//! The probability of a histogram: the first avalanche of each shot, bin by bin.
//!
//! As [`tofsim::optics`] has it, with the pulse itself in place of its broken line: H(t) = N t +
//! S F(t - mu), H(0) = 0, and a code has the probability exp(-H(a)) - exp(-H(b)), summed
//! over its spans; what lies between the spans and after them has no code. The histogram, with the
//! shots without a code as one more cell, is a multinomial number.
//!
//! Jitter is a convolution ([`super::stretches`]) of the first avalanches, not of the hazard: pile-up
//! comes before it. In MODE 1 not every shot finds the diode armed, nor the chain empty
//! ([`super::arming`]).
//!
//! Coordinates are mu / sigma and ln S of each echo, the amplitude of the cover window's light if there is a template of
//! it (1: as calibrated), and last N times the end of the last bin: numbers of order 1, and S stays positive. There are
//! three of them, or five for two echoes, whose hazards add up, and one more with a template: an even number.

use std::array;
use std::sync::Arc;

use tofsim::error::Input;
use tofsim::kernel::pulse::Pulse;
use tofsim::optics::Budget;
use tofsim::scenario::glass::GlassTemplate;

use crate::estimation::acquisition::{
    ARRIVAL_PS_PER_M, Acquisition, Echo, FreeRunning, echoes as echoes_of,
};

use super::arming::Arming;
use super::solve::{Matrix, inverse_diagonal};
use super::stretches::{Stretch, Stretches};

/// Background that is as good as none: hits of it in all shots [hits].
const LEAST: f64 = 0.01;
/// Signal below which no climb begins [1].
const FAINTEST: f64 = 1e-7;
/// A small step of a coordinate of order 1 [1].
const SMALL: f64 = 1e-3;
/// Probability that is as good as none [1].
const IMPROBABLE: f64 = 1e-250;

/// The model of one pulse and one chain.
#[derive(Clone, Debug)]
pub struct Model {
    /// Stretches in order of time, from 0 on.
    stretches: Arc<[Stretch]>,
    /// Codes that have a cell of their own.
    known: Vec<bool>,
    /// Length of a stretch, if all have the same [ps].
    step_ps: f64,
    /// Model of the shots that find the SPAD armed; without one, all do.
    pub(super) free_running: Option<FreeRunning>,
    /// Shots of the histogram [shots].
    pub(super) shots: u64,
    pulse: Pulse,
    /// Its standard deviation [ps].
    pub(super) sigma_ps: f64,
    /// End of the last bin [ps].
    pub(super) end_ps: f64,
    /// Template of the cover window's light: its hazard from the laser edge to the end of each stretch [1].
    glass: Option<Arc<[f64]>>,
    /// All photons of the template [1].
    photons: Option<f64>,
}

/// Returns the number of echoes among so many coordinates.
pub(super) const fn echoes<const N: usize>() -> usize {
    (N - 1) / 2
}

/// Returns the coordinate of the window's light, if it is among so many coordinates.
pub(super) const fn pedestal<const N: usize>() -> Option<usize> {
    if N.is_multiple_of(2) { Some(N - 2) } else { None }
}

/// Probabilities of the cells and their derivatives by the coordinates.
struct Cells<const N: usize> {
    of: Vec<f64>,
    by: Vec<[f64; N]>,
}

impl Model {
    /// For histograms that come about so.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails, or clock edges jitter and there is a template of a cover window.
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        acquisition.check()?;
        let Stretches { stretches, known, step_ps, end_ps } = Stretches::new(acquisition);
        let Acquisition { shots, free_running, .. } = *acquisition;
        let pulse = acquisition.pulse.clone();
        let sigma_ps = pulse.sigma_ps();
        if acquisition.glass.is_some() && acquisition.jitter_ps > 0.0 {
            let expected = "expected none where clock edges jitter (pll.jitter_rms_ps): jitter is in the template \
                            already, and would blur it twice";
            return Err(Input::new("acquisition", expected).field("estimator.glass_file"));
        }
        let glass = acquisition.glass.map(|glass| cumulated(glass, &stretches));
        let photons = acquisition.glass.map(GlassTemplate::photons);
        Ok(Model {
            stretches,
            known,
            step_ps,
            free_running,
            shots,
            pulse,
            sigma_ps,
            end_ps,
            glass,
            photons,
        })
    }

    /// Whether the window's light is in the model.
    pub fn has_pedestal(&self) -> bool {
        self.glass.is_some()
    }

    /// Cells: the codes, and last no code.
    fn cell_count(&self) -> usize {
        self.known.len() + 1
    }

    /// Lower limit of the last coordinate.
    pub fn least_background(&self) -> f64 {
        LEAST / self.shots as f64
    }

    /// Coordinates of an echo, within their limits.
    pub fn coordinates(&self, echo: &Echo) -> [f64; 3] {
        let background = echo.background_per_ps * self.end_ps;
        let signal = echo.signal.max(FAINTEST);
        [
            echo.arrival_ps / self.sigma_ps,
            libm::log(signal),
            background.max(self.least_background()),
        ]
    }

    /// Coordinates of an echo and of a window's light, within their limits.
    pub fn coordinates_with(&self, echo: &Echo, amplitude: f64) -> [f64; 4] {
        let [arrival, signal, background] = self.coordinates(echo);
        [arrival, signal, amplitude.max(0.0), background]
    }

    /// An echo at coordinates, the first or the second.
    pub fn echo<const N: usize>(&self, at: &[f64; N], which: usize) -> Echo {
        Echo {
            arrival_ps: at[2 * which] * self.sigma_ps,
            signal: libm::exp(at[2 * which + 1]),
            background_per_ps: at[N - 1] / self.end_ps,
        }
    }

    /// Logarithm of the histogram's probability at an echo, but for a constant.
    pub fn log_likelihood_of(&self, echo: &Echo, histogram: &[u32]) -> f64 {
        self.log_likelihood(&self.coordinates(echo), histogram)
    }

    /// Logarithm of the histogram's probability, but for a constant.
    pub fn log_likelihood<const N: usize>(&self, at: &[f64; N], histogram: &[u32]) -> f64 {
        let terms = self.counts(histogram).zip(self.chances(at));
        terms
            .map(|(count, p)| if count > 0.0 { count * libm::log(p.max(IMPROBABLE)) } else { 0.0 })
            .sum()
    }

    /// Derivatives of the log likelihood, and Fisher's information.
    pub fn slope<const N: usize>(&self, at: &[f64; N], histogram: &[u32]) -> ([f64; N], Matrix<N>) {
        let cells = self.cells(at);
        let mut gradient = [0.0; N];
        for ((count, &p), by) in self.counts(histogram).zip(&cells.of).zip(&cells.by) {
            if count > 0.0 && p > IMPROBABLE {
                gradient = array::from_fn(|k| gradient[k] + count * by[k] / p);
            }
        }
        (gradient, self.information(&cells))
    }

    /// The Cramér-Rao bound without a window's light: the smallest standard deviation that an unbiased estimate of the
    /// distance can have, if signal and background are not known either [m]. `None` where the
    /// histogram tells nothing.
    pub fn cramer_rao_m(&self, echo: &Echo) -> Option<f64> {
        self.deviations_m(self.coordinates(echo)).map(|[deviation_m, ..]| deviation_m)
    }

    /// Returns the same bound for the distance of each echo of a scene, one or two: with the other echo, and the
    /// amplitude of the window's light if there is a template of it, unknown too. The background is the first echo's [m].
    pub fn cramer_rao_of(&self, echoes: &[Echo], amplitude: f64) -> Option<Vec<f64>> {
        match (echoes, self.has_pedestal()) {
            ([echo], false) => Some(vec![self.cramer_rao_m(echo)?]),
            ([echo], true) => {
                let deviations = self.deviations_m(self.coordinates_with(echo, amplitude))?;
                Some(deviations[..1].to_vec())
            }
            ([one, other], false) => {
                let deviations = self.deviations_m(self.coordinates_of_two(one, other))?;
                Some(deviations[..2].to_vec())
            }
            ([one, other], true) => {
                let [place, signal, second, second_signal, background] =
                    self.coordinates_of_two(one, other);
                let at = [place, signal, second, second_signal, amplitude, background];
                Some(self.deviations_m(at)?[..2].to_vec())
            }
            _ => None,
        }
    }

    /// Returns the bound of the target's distance in a plain scene: with a second surface, at `second_m`, and the cover
    /// window's light, if there are such [m].
    pub fn bound_of_scene_m(&self, budget: &Budget, second_m: f64) -> Option<f64> {
        let amplitude = self.photons.map_or(0.0, |photons| budget.cover_per_shot / photons);
        self.cramer_rao_of(&echoes_of(budget, second_m), amplitude)?.first().copied()
    }

    /// Coordinates of two echoes, with the background of the first.
    pub fn coordinates_of_two(&self, one: &Echo, other: &Echo) -> [f64; 5] {
        let [place, signal, background] = self.coordinates(one);
        let [second, second_signal, _] = self.coordinates(other);
        [place, signal, second, second_signal, background]
    }

    /// Bounds of the distances of the echoes, which come first [m].
    fn deviations_m<const N: usize>(&self, at: [f64; N]) -> Option<[f64; N]> {
        let variances = inverse_diagonal(&self.information(&self.cells(&at)), &[false; N])?;
        let deviation_m = |echo: usize| {
            let variance: f64 = variances.get(2 * echo).copied().unwrap_or_default();
            variance.sqrt() * self.sigma_ps / ARRIVAL_PS_PER_M
        };
        Some(array::from_fn(deviation_m))
    }

    /// When a part of the pulse has come, from its mean [ps].
    pub(super) fn when_ps(&self, part: f64) -> f64 {
        self.pulse.when(part)
    }

    /// The probability of each code, where it has a cell of its own, without a window's light; 0 elsewhere [1].
    pub fn probabilities(&self, echo: &Echo) -> Vec<f64> {
        self.probabilities_at(&self.coordinates(echo))
    }

    /// The same at coordinates.
    pub fn probabilities_at<const N: usize>(&self, at: &[f64; N]) -> Vec<f64> {
        let mut chances = self.chances(at);
        chances.pop();
        chances
    }

    /// Counts of the cells; last the shots without a code.
    fn counts<'a>(&'a self, histogram: &'a [u32]) -> impl Iterator<Item = f64> + 'a {
        let own = histogram.iter().zip(&self.known);
        let own = own.map(|(&count, &known)| if known { u64::from(count) } else { 0 });
        let without = self.shots.saturating_sub(own.clone().sum()) as f64;
        own.map(|count| count as f64).chain([without])
    }

    /// Expected curvature of the log likelihood.
    fn information<const N: usize>(&self, cells: &Cells<N>) -> Matrix<N> {
        let mut matrix = [[0.0; N]; N];
        for (&p, by) in cells.of.iter().zip(&cells.by) {
            if p > IMPROBABLE {
                let weight = self.shots as f64 / p;
                for (row, a) in matrix.iter_mut().zip(by) {
                    row.iter_mut().zip(by).for_each(|(element, b)| *element += weight * a * b);
                }
            }
        }
        matrix
    }

    /// H at the end of a stretch.
    fn hazard<const N: usize>(
        &self,
        at: &[f64; N],
        signals: &[f64; N],
        (t_ps, glass): (f64, f64),
    ) -> f64 {
        let mut h = at[N - 1] * (t_ps / self.end_ps);
        if let Some(k) = pedestal::<N>() {
            h += at[k] * glass;
        }
        for k in (0..2 * echoes::<N>()).step_by(2) {
            h += signals[k + 1] * self.pulse.part(t_ps - at[k] * self.sigma_ps);
        }
        h
    }

    /// H and its derivatives at the end of a stretch.
    fn hazard_and_slope<const N: usize>(
        &self,
        at: &[f64; N],
        signals: &[f64; N],
        (t_ps, glass): (f64, f64),
    ) -> (f64, [f64; N]) {
        let of_end = t_ps / self.end_ps;
        let (mut h, mut by) = (at[N - 1] * of_end, [of_end; N]);
        if let Some(k) = pedestal::<N>() {
            h += at[k] * glass;
            by[k] = glass;
        }
        for k in (0..2 * echoes::<N>()).step_by(2) {
            let since_ps = t_ps - at[k] * self.sigma_ps;
            let density = self.pulse.density(since_ps) * self.sigma_ps;
            let part = signals[k + 1] * self.pulse.part(since_ps);
            h += part;
            (by[k], by[k + 1]) = (-signals[k + 1] * density, part);
        }
        (h, by)
    }

    /// The probabilities that a shot's first avalanche is in each stretch, and that there is none.
    fn first<const N: usize>(&self, at: &[f64; N]) -> (Vec<f64>, f64) {
        let (signals, mut h, mut none_yet) = (signals(at), 0.0, 1.0);
        let stretches = self.stretches.iter().enumerate();
        let first = stretches.map(|(k, stretch)| {
            let next = self.hazard(at, &signals, (stretch.until_ps, self.glass_until(k)));
            // In this form a small difference keeps its digits.
            let p = -none_yet * libm::expm1(h - next);
            (h, none_yet) = (next, libm::exp(-next));
            p
        });
        (first.collect(), none_yet)
    }

    /// Hazard of the template from the laser edge to the end of a stretch.
    fn glass_until(&self, stretch: usize) -> f64 {
        self.glass.as_ref().map_or(0.0, |glass| glass[stretch])
    }

    /// The probability of each cell.
    fn chances<const N: usize>(&self, at: &[f64; N]) -> Vec<f64> {
        if let Some(free) = &self.free_running {
            return self.free_chances(free, at);
        }
        let ((first, none), mut of) = (self.first(at), vec![0.0; self.cell_count()]);
        for (stretch, p) in self.stretches.iter().zip(first) {
            stretch.cells.iter().for_each(|&(cell, part)| of[cell] += p * part);
        }
        of[self.known.len()] += none;
        of
    }

    fn cells<const N: usize>(&self, at: &[f64; N]) -> Cells<N> {
        if let Some(free) = &self.free_running {
            return self.free_cells(free, at);
        }
        let mut cells =
            Cells { of: vec![0.0; self.cell_count()], by: vec![[0.0; N]; self.cell_count()] };
        let signals = signals(at);
        // The probability of no avalanche so far is exp(-h).
        let (mut h, mut none_yet, mut by) = (0.0, 1.0, [0.0; N]);
        for (k, stretch) in self.stretches.iter().enumerate() {
            let end = (stretch.until_ps, self.glass_until(k));
            let (next, next_by) = self.hazard_and_slope(at, &signals, end);
            let none_after = libm::exp(-next);
            // In this form a small difference keeps its digits.
            let p = -none_yet * libm::expm1(h - next);
            let grown: [f64; N] = array::from_fn(|k| (next_by[k] - by[k]) * none_after - by[k] * p);
            for &(cell, part) in &stretch.cells {
                cells.add(cell, p * part, grown.map(|by| by * part));
            }
            (h, none_yet, by) = (next, none_after, next_by);
        }
        cells.add(self.known.len(), none_yet, by.map(|by| -by * none_yet));
        cells
    }

    /// The probabilities in MODE 1, where the scene decides how often the diode is armed too: one echo alone.
    fn free_chances<const N: usize>(&self, free: &FreeRunning, at: &[f64; N]) -> Vec<f64> {
        let arming = Arming::new(free, &self.pulse, self.step_ps, &self.echo(at, 0));
        let (last, mut of) = (self.known.len(), vec![0.0; self.cell_count()]);
        for (stretch, p) in self.stretches.iter().zip(arming.show(&self.first(at).0)) {
            stretch.cells.iter().for_each(|&(cell, part)| of[cell] += p * part);
        }
        of[last] = (1.0 - of[..last].iter().sum::<f64>()).max(0.0);
        of
    }

    /// The same with derivatives, by differences.
    fn free_cells<const N: usize>(&self, free: &FreeRunning, at: &[f64; N]) -> Cells<N> {
        let mut steps = [SMALL; N];
        steps[N - 1] = SMALL * at[N - 1] + self.least_background();
        let moved = |k: usize, by: f64| {
            let mut to = *at;
            to[k] += by;
            self.free_chances(free, &to)
        };
        let sides: [_; N] = array::from_fn(|k| [moved(k, steps[k]), moved(k, -steps[k])]);
        let slope =
            |cell: usize, k: usize| (sides[k][0][cell] - sides[k][1][cell]) / steps[k] / 2.0;
        let by = (0..self.cell_count()).map(|cell| array::from_fn(|k| slope(cell, k))).collect();
        Cells { of: self.free_chances(free, at), by }
    }
}

/// S, where the coordinates have ln S.
fn signals<const N: usize>(at: &[f64; N]) -> [f64; N] {
    let is_signal = |k: usize| k % 2 == 1 && k < 2 * echoes::<N>();
    array::from_fn(|k| if is_signal(k) { libm::exp(at[k]) } else { 0.0 })
}

/// Hazard of a template from the laser edge to the end of each stretch. A code's light is spread evenly over its
/// stretches.
fn cumulated(glass: &GlassTemplate, stretches: &[Stretch]) -> Arc<[f64]> {
    let mut widths_ps = vec![0.0; glass.bins().len()];
    let lengths_ps: Vec<_> = stretches
        .iter()
        .scan(0.0, |from_ps, stretch| {
            Some(stretch.until_ps - std::mem::replace(from_ps, stretch.until_ps))
        })
        .collect();
    let code = |stretch: &Stretch| stretch.cells.first().map(|&(cell, _)| cell);
    for (stretch, length_ps) in stretches.iter().zip(&lengths_ps) {
        if let Some(width_ps) = code(stretch).and_then(|code| widths_ps.get_mut(code)) {
            *width_ps += length_ps;
        }
    }
    let mut sum = 0.0;
    let until = |(stretch, length_ps): (&Stretch, &f64)| {
        if let Some((code, bin)) =
            code(stretch).and_then(|code| Some((code, glass.bins().get(code)?)))
        {
            sum += bin.hazard * length_ps / widths_ps[code];
        }
        sum
    };
    stretches.iter().zip(&lengths_ps).map(until).collect()
}

impl<const N: usize> Cells<N> {
    fn add(&mut self, cell: usize, p: f64, by: [f64; N]) {
        self.of[cell] += p;
        self.by[cell].iter_mut().zip(by).for_each(|(sum, by)| *sum += by);
    }
}
