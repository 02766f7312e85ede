//! A scene with two echoes, and how well the place of each can be known.

use rand::{Rng, RngExt};

use tofsim::kernel::Time;
use tofsim::optics::{BinProbabilities, Budget, Hazard};
use tofsim_learn::estimation::acquisition::ARRIVAL_PS_PER_M;

use super::super::super::SHOTS;
use super::super::{Instrument, Scene};

/// Step of a coordinate of order 1, of which derivatives are made [1].
const SMALL: f64 = 0.02;

/// Two surfaces in a beam: arrivals [sigma], the logarithms of both signals, and of the ambient light [1/ps], as
/// mu1, log S1, mu2, log S2, log b.
#[derive(Clone, Copy, Debug)]
pub struct Pair(pub [f64; 5]);

impl Pair {
    /// A first echo of 0.05 to 1 photons a shot between 0.2 and 0.5 m in 0 to 0.4 W/m2/nm, and a second one that
    /// comes so many deviations of the pulse later and is so many times as strong.
    pub fn random(
        instrument: &Instrument,
        apart: f64,
        strength: f64,
        random: &mut impl Rng,
    ) -> Self {
        let mut scenario = instrument.setup.scenario.clone();
        scenario.ambient.irradiance_w_m2_nm = random.random_range(0.0..0.4);
        let budget = Budget::new(&scenario, instrument.setup.budget.pulse.clone());
        let sigma_ps = instrument.setup.budget.pulse.sigma_ps();
        let first = random.random_range(0.2..0.5) * ARRIVAL_PS_PER_M / sigma_ps;
        let signal = random.random_range(f64::ln(0.05)..0.0);
        let ambient = (budget.background_rate_hz() * 1e-12).ln();
        Pair([first, signal, first + apart, signal + strength.ln(), ambient])
    }

    /// Distances of both [m].
    pub fn distances_m(&self, instrument: &Instrument) -> [f64; 2] {
        let sigma_ps = instrument.setup.budget.pulse.sigma_ps();
        [0, 2].map(|k| self.0[k] * sigma_ps / ARRIVAL_PS_PER_M)
    }

    /// Chances of the codes: the hazards of both echoes and of the ambient light add up.
    fn codes(&self, instrument: &Instrument) -> BinProbabilities {
        let Pair([first, signal, second, other, ambient]) = *self;
        let pulse = &instrument.setup.budget.pulse;
        let echo = |arrival: f64, signal: f64, ambient_rate_hz: f64| {
            Hazard::new(&Budget {
                signal_per_shot: signal.exp(),
                mean_arrival: Time::from_ps_f64(arrival * pulse.sigma_ps()),
                ambient_rate_hz,
                pulse: pulse.clone(),
                ..Budget::default()
            })
        };
        let hazards = [echo(first, signal, ambient.exp() * 1e12), echo(second, other, 0.0)];
        BinProbabilities::of_all(&hazards, &instrument.bins)
    }

    /// The scene, and the bounds of both distances [m].
    pub fn scene<'a>(&self, instrument: &'a Instrument) -> (Scene<'a>, [f64; 2]) {
        let codes = self.codes(instrument);
        let bounds_m = self.bounds_m(instrument, codes.of_code());
        let signal = self.0[1].exp();
        (Scene { instrument, shots: SHOTS, codes, bound_m: bounds_m[0], signal }, bounds_m)
    }

    /// The scene without bounds, of a first echo alone if the second has no strength.
    pub fn alone<'a>(&self, instrument: &'a Instrument, shots: u64) -> Scene<'a> {
        let codes = self.codes(instrument);
        Scene { instrument, shots, codes, bound_m: 0.0, signal: self.0[1].exp() }
    }

    /// Cramér-Rao bounds of both distances, where all five coordinates are unknown [m].
    fn bounds_m(&self, instrument: &Instrument, chances: &[f64]) -> [f64; 2] {
        let moved = |k: usize, by: f64| {
            let mut to = *self;
            to.0[k] += by;
            to.codes(instrument)
        };
        let sides = [0, 1, 2, 3, 4].map(|k| [moved(k, SMALL), moved(k, -SMALL)]);
        let mut information = [[0.0; 5]; 5];
        let mut add = |chance: f64, by: [f64; 5]| {
            let weight = if chance > 1e-15 { SHOTS as f64 / chance } else { 0.0 };
            for (row, a) in information.iter_mut().zip(by) {
                row.iter_mut().zip(by).for_each(|(element, b)| *element += weight * a * b);
            }
        };
        let mut none = [0.0; 5];
        for (code, &chance) in chances.iter().enumerate() {
            let by = sides.each_ref().map(|[after, before]| {
                (after.of_code()[code] - before.of_code()[code]) / (2.0 * SMALL)
            });
            (0..5).for_each(|k| none[k] -= by[k]);
            add(chance, by);
        }
        add(1.0 - chances.iter().sum::<f64>(), none);
        let sigma_m = instrument.setup.budget.pulse.sigma_ps() / ARRIVAL_PS_PER_M;
        [0, 2].map(|k| inverse_diagonal(information, k).sqrt() * sigma_m)
    }
}

/// An element of the diagonal of a matrix's inverse, by Gauss and Jordan.
fn inverse_diagonal(mut matrix: [[f64; 5]; 5], which: usize) -> f64 {
    let mut right = [0.0; 5];
    right[which] = 1.0;
    for k in 0..5 {
        let (row, value) =
            (matrix[k].map(|element| element / matrix[k][k]), right[k] / matrix[k][k]);
        for other in (0..5).filter(|other| *other != k) {
            let times = matrix[other][k];
            (0..5).for_each(|column| matrix[other][column] -= times * row[column]);
            right[other] -= times * value;
        }
        (matrix[k], right[k]) = (row, value);
    }
    right[which]
}
