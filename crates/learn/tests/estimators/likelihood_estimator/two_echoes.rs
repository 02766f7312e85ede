//! Two surfaces in a beam: what an estimator of one echo makes of two, and what can be made of them together.

mod firmware;
mod joint;
mod one_echo;
mod pair;

use rayon::prelude::*;

use tofsim::firmware::tof_top::status::{Status, StatusSet};
use tofsim::sensor::streams::{Source, stream};
use tofsim::sim::estimates::likelihood::Found;

use super::{Instrument, Tally};
use pair::Pair;

/// Delays of the second echo after the first [sigma].
const APART: [f64; 10] = [1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 15.0];
/// Strengths of the second echo relative to the first [1].
const STRENGTHS: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
/// An error of so many of its own deviations is no chance [1].
const FAR: f64 = 6.0;
/// A chi-square that is so many of its deviations above its mean is no chance [1].
const MOST_CHI: f64 = 3.0;

/// Each pair of both.
fn cells() -> Vec<(f64, f64)> {
    APART.into_iter().flat_map(|apart| STRENGTHS.map(|strength| (apart, strength))).collect()
}

/// Whether a fit of so many bins has a chi-square that is no chance.
fn is_unlikely(found: &Found, bins: usize) -> bool {
    let bins = bins as f64;
    found.chi_square() > bins + MOST_CHI * (2.0 * bins).sqrt()
}

/// Results of the firmware's estimator for many pairs.
#[derive(Clone, Copy, Debug, Default)]
struct Outcomes {
    drawn: f64,
    /// Depths without a status, against the first echo.
    silent: Tally,
    /// Those of them that are far from it, but have a large chi-square; and those that are far from both.
    seen: f64,
    astray: f64,
    /// Depths whose only status is another echo, against the nearer one, the first or the second.
    of_first: Tally,
    of_second: Tally,
    /// How often the histogram does not fit, whatever else is said.
    unfit: f64,
}

impl Outcomes {
    fn add(&mut self, found: &Found, distances_m: [f64; 2], bounds_m: [f64; 2], bins: usize) {
        self.drawn += 1.0;
        self.unfit += f64::from(found.status.contains(Status::NoFit));
        let [first_m, second_m] = distances_m.map(|m| (found.depth_m() - m).abs());
        let far_m = FAR * found.sigma_m();
        let believed = Found { status: StatusSet::default(), ..*found };
        match &found.status.words()[..] {
            [] => {
                self.silent.add(found, distances_m[0], bounds_m[0]);
                self.seen += f64::from(first_m > far_m && is_unlikely(found, bins));
                self.astray += f64::from(first_m.min(second_m) > far_m);
            }
            ["another echo"] if first_m <= second_m => {
                self.of_first.add(&believed, distances_m[0], bounds_m[0]);
            }
            ["another echo"] => self.of_second.add(&believed, distances_m[1], bounds_m[1]),
            _ => {}
        }
    }

    /// How many, and of those with a depth the rms error over the bound, the mean error and the rms error in
    /// deviations of their own.
    fn row(&self) -> String {
        let percent = |part: f64| 100.0 * part / self.drawn;
        let figures = |tally: &Tally| {
            let (ratio, own, bias) = (tally.ratio(), tally.own(), tally.bias());
            format!("{:5.1} %: {ratio:5.2} {bias:+6.2} {own:5.2}", percent(tally.kept))
        };
        let [unfit, far, seen, astray] =
            [self.unfit, self.silent.far, self.seen, self.astray].map(percent);
        let (silent, first) = (figures(&self.silent), figures(&self.of_first));
        let second = figures(&self.of_second);
        format!(
            "no fit {unfit:5.1} %, no status {silent}, far {far:5.2} %, seen {seen:5.2} %, \
             from both {astray:5.2} % | another alone, at the first {first} | at the second {second}"
        )
    }
}

fn outcomes(instrument: &Instrument, (apart, strength): (f64, f64), count: u64) -> Outcomes {
    let number = (1e4 * apart + 10.0 * strength) as u64;
    let mut random = stream(28, Source::Histogram, number);
    let mut outcomes = Outcomes::default();
    for _ in 0..count {
        let pair = Pair::random(instrument, apart, strength, &mut random);
        let (scene, bounds_m) = pair.scene(instrument);
        let found = scene.look(&scene.draw(&mut random));
        let bins = instrument.params.fitted();
        outcomes.add(&found, pair.distances_m(instrument), bounds_m, bins);
    }
    outcomes
}

fn all(cells: &[(f64, f64)], count: u64) -> Vec<((f64, f64), Outcomes)> {
    let instrument = Instrument::load("kc705", &[]);
    let outcomes = cells.par_iter().map(|cell| (*cell, outcomes(&instrument, *cell, count)));
    let outcomes: Vec<_> = outcomes.collect();
    for ((apart, strength), outcomes) in &outcomes {
        println!("{apart:4} sigma, {strength:3}: {}", outcomes.row());
    }
    outcomes
}

#[test]
#[ignore = "prints the table of docs/accuracy.md: 160,000 histograms take a minute or more"]
fn prints_what_is_said_of_two_echoes() {
    all(&cells(), 4000);
}

/// The hits of the other echo are taken for ambient light, which costs a part of a deviation.
#[test]
fn the_first_of_two_separate_echoes_is_near_the_bound_of_both() {
    let separate = cells().into_iter().filter(|&(apart, strength)| apart >= 7.0 && strength <= 1.0);
    for ((apart, strength), outcomes) in all(&separate.collect::<Vec<_>>(), 600) {
        let Outcomes { silent, of_first, .. } = outcomes;
        let row = format!("{apart} sigma, {strength}: {}", outcomes.row());
        // Three standard errors above what it is in many.
        assert!(of_first.ratio() < 1.15 && (0.85..1.15).contains(&of_first.own()), "{row}");
        assert!((0.0..0.45).contains(&of_first.bias()) && silent.far <= 1.0, "{row}");
        assert!(of_first.kept + silent.kept > 0.85 * outcomes.drawn, "{row}");
    }
}

/// It does not know better than that there is one echo, and its chi-square does.
#[test]
#[ignore = "long: ./check --full"]
fn most_depths_that_overlapping_echoes_lead_astray_have_a_large_chi_square() {
    let overlapping = cells().into_iter().filter(|&(apart, _)| apart <= 2.0);
    for ((apart, strength), outcomes) in all(&overlapping.collect::<Vec<_>>(), 300) {
        let row = format!("{apart} sigma, {strength}: {}", outcomes.row());
        assert!(outcomes.silent.far > 0.02 * outcomes.drawn, "it has learnt to tell: {row}");
        assert!(outcomes.seen > 0.6 * outcomes.silent.far, "{row}");
    }
}
