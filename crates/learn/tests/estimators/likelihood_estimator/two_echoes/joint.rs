//! Both echoes fitted together, in floating point.

use rayon::prelude::*;

use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::Acquisition;
use tofsim_learn::estimation::acquisition::ARRIVAL_PS_PER_M;
use tofsim_learn::estimation::likelihood::{Fit, Likelihood};

use super::super::super::SHOTS;
use super::super::Instrument;
use super::{Pair, cells};

/// The estimator of an instrument.
pub fn likelihood(instrument: &Instrument) -> Likelihood {
    let pulse = &instrument.setup.budget.pulse;
    Likelihood::new(&Acquisition::new(&instrument.bins, SHOTS, pulse)).unwrap()
}

/// Errors of the fits of an echo.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    count: f64,
    /// Squares of errors, each over its bound's: the scenes are far from alike.
    squares: f64,
    /// Errors in standard deviations of their own, their squares, and how many are over six.
    deviations: f64,
    relative: f64,
    far: f64,
}

impl Errors {
    fn add(&mut self, fit: &Fit, distance_m: f64, bound_m: f64) {
        let error_m = fit.echo.arrival_ps / ARRIVAL_PS_PER_M - distance_m;
        let deviations = error_m / (fit.arrival_deviation_ps / ARRIVAL_PS_PER_M);
        self.count += 1.0;
        self.squares += (error_m / bound_m).powi(2);
        self.deviations += deviations;
        self.relative += deviations * deviations;
        self.far += f64::from(deviations.abs() > 6.0);
    }

    /// Root mean square of the errors, each over its bound.
    fn ratio(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }

    /// The same in deviations of their own.
    fn own(&self) -> f64 {
        (self.relative / self.count).sqrt()
    }

    fn row(&self, drawn: f64) -> String {
        let (percent, bias) = (100.0 * self.count / drawn, self.deviations / self.count);
        let (ratio, own, far) = (self.ratio(), self.own(), self.far);
        format!("{percent:5.1} %: {ratio:5.2} {bias:+6.2} {own:5.2}, far {far}")
    }
}

/// Of so many pairs: those that are found, the first and the second, and the fit of one echo to all others.
fn errors(instrument: &Instrument, (apart, strength): (f64, f64), count: u64) -> [Errors; 3] {
    let mut random = stream(29, Source::Histogram, (1e4 * apart + 10.0 * strength) as u64);
    let likelihood = likelihood(instrument);
    let mut errors = [Errors::default(); 3];
    for _ in 0..count {
        let pair = Pair::random(instrument, apart, strength, &mut random);
        let (scene, bounds_m) = pair.scene(instrument);
        let histogram = scene.draw(&mut random);
        let distances_m = pair.distances_m(instrument);
        let Ok(alone) = likelihood.fit(&histogram) else { continue };
        let Some(both) = likelihood.fit_both(&histogram, &alone) else {
            errors[2].add(&alone, distances_m[0], bounds_m[0]);
            continue;
        };
        errors[0].add(&both.first, distances_m[0], bounds_m[0]);
        errors[1].add(&both.second, distances_m[1], bounds_m[1]);
    }
    errors
}

fn all(cells: Vec<(f64, f64)>, count: u64) -> Vec<((f64, f64), [Errors; 3])> {
    let instrument = Instrument::load("kc705", &[]);
    let errors = cells.into_par_iter().map(|cell| (cell, errors(&instrument, cell, count)));
    let errors: Vec<_> = errors.collect();
    for ((apart, strength), [first, second, alone]) in &errors {
        let [first, second, alone] = [first, second, alone].map(|of| of.row(count as f64));
        println!("{apart:4} sigma, {strength:3}: first {first} | second {second} | alone {alone}");
    }
    errors
}

#[test]
#[ignore = "prints the table of docs/accuracy.md: 40,000 fits take minutes"]
fn prints_what_a_fit_of_both_comes_to() {
    all(cells(), 1000);
}

#[test]
#[ignore = "long: ./check --full"]
fn both_echoes_are_at_their_bound_from_two_sigma_on() {
    let apart = [2.0, 3.0, 5.0, 8.0];
    let cells = apart.into_iter().flat_map(|apart| [(apart, 0.3), (apart, 1.0), (apart, 3.0)]);
    for ((apart, strength), [first, second, _]) in all(cells.collect(), 250) {
        for (of, most) in [(first, 1.1), (second, 1.15)] {
            let row = format!("{apart} sigma, {strength}: {}", of.row(250.0));
            // A ratio of 250 has a standard error of 0.045.
            assert!(of.ratio() < most && (0.85..1.15).contains(&of.own()), "{row}");
            assert!(of.far == 0.0 && of.count > 170.0, "{row}");
        }
    }
}
