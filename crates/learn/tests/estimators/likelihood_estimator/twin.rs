//! The same algorithm in double precision: what the integers lose.

use rayon::prelude::*;

use tofsim::kernel::pulse::normal_cdf;
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::acquisition::ARRIVAL_PS_PER_M;

use super::super::{DISTANCES_M, SHOTS};
use super::Instrument;
use super::thesis::places;

/// Deviations of the pulse to either side of its mean that a step looks at.
const REACH: f64 = 4.5;
/// The part of a pulse within 2.8 deviations, and its inverse.
const BOX_SIGMA: f64 = 2.8;
const OUT_OF_BOX: f64 = 1.19;
/// Addition to the diagonal of the information for arrival, signal and ambient light [counts].
const RIDGE: [f64; 3] = [1.0 / 16.0, 1.0 / 16.0, 1.0];
/// Longest step of the arrival [sigma].
const LONGEST: f64 = 0.8;

/// Bins, pulse and shots in floating point.
struct Twin {
    edges_ps: Vec<f64>,
    bin_ps: f64,
    sigma_ps: f64,
    shots: f64,
}

/// A histogram, with the shots that wait for each bin.
struct Waited<'a> {
    twin: &'a Twin,
    counts: Vec<f64>,
    waiting: Vec<f64>,
}

/// Arrival [ps], signal [1] and ambient hazard [1/ps].
#[derive(Clone, Copy)]
struct Point {
    arrival_ps: f64,
    signal: f64,
    ambient: f64,
}

impl Twin {
    fn of(instrument: &Instrument) -> Self {
        Twin {
            edges_ps: instrument.bins.edges_ps(),
            bin_ps: instrument.bins.bin_ps(),
            sigma_ps: instrument.setup.scenario.laser.pulse_sigma_ps,
            shots: SHOTS as f64,
        }
    }

    fn bins(&self) -> usize {
        self.edges_ps.len() - 1
    }

    fn width_ps(&self, bin: usize) -> f64 {
        self.edges_ps[bin + 1] - self.edges_ps[bin]
    }

    fn distance_m(&self, histogram: &[u32]) -> f64 {
        let counts: Vec<_> = histogram.iter().map(|&count| f64::from(count)).collect();
        let mut left = self.shots;
        let waiting = counts.iter().map(|count| {
            left -= count;
            left + count
        });
        let waited = Waited { twin: self, waiting: waiting.collect(), counts };
        let mut point = waited.start(waited.ambient());
        for _ in 0..6 {
            point = waited.step(&point);
        }
        point.arrival_ps / ARRIVAL_PS_PER_M
    }
}

impl Waited<'_> {
    /// Hits by the time that shots waited for them, in the block at three eighths of the order [1/ps].
    fn ambient(&self) -> f64 {
        let blocks = (0..self.twin.bins()).collect::<Vec<_>>();
        let blocks = blocks.chunks(self.twin.bins() / 8).map(|block| {
            let waited = |&bin: &usize| self.waiting[bin] * self.twin.width_ps(bin);
            let hits = block.iter().map(|&bin| self.counts[bin]).sum::<f64>();
            (hits, block.iter().map(waited).sum::<f64>())
        });
        let blocks: Vec<_> = blocks.collect();
        let most = blocks.iter().map(|(_, waited)| *waited).fold(0.0, f64::max);
        let usable = blocks.iter().filter(|(_, waited)| *waited > most / 64.0);
        let mut rates: Vec<_> = usable.map(|(hits, waited)| hits / waited).collect();
        rates.sort_by(f64::total_cmp);
        let part = rates[3 * (rates.len() - 1) / 8] * self.twin.bin_ps / 64.0;
        let part = part.max((-24f64).exp2());
        (part + part * part / 2.0) / (self.twin.bin_ps / 64.0)
    }

    /// Returns the point of the box with the largest excess.
    fn start(&self, ambient: f64) -> Point {
        let twin = self.twin;
        let bins = twin.bins() as i64;
        let length = (BOX_SIGMA * twin.sigma_ps / twin.bin_ps).round() as i64;
        let chance = 1.0 - (-ambient * twin.bin_ps).exp();
        let score = |first: i64| {
            let inside = first.max(0) as usize..(first + length).min(bins) as usize;
            let (mut hits, mut expected, mut exposed) = (0.0, 0.0, 0.0);
            for bin in inside.clone() {
                let (waiting, count) = (self.waiting[bin], self.counts[bin]);
                let of_bin = waiting * chance * twin.width_ps(bin) / twin.bin_ps;
                expected += of_bin + if waiting > 0.0 { 0.1 } else { 0.0 };
                hits += count;
                exposed += waiting - count / 2.0;
            }
            let more: f64 = (hits - expected).max(0.0);
            let middle_ps = (twin.edges_ps[inside.start] + twin.edges_ps[inside.end]) / 2.0;
            (more * more / expected, middle_ps, OUT_OF_BOX * length as f64 * more / exposed)
        };
        let all = (1 - length..bins).map(score);
        let (_, arrival_ps, signal) = all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        Point { arrival_ps, signal, ambient }
    }

    /// A step of Fisher scoring.
    fn step(&self, at: &Point) -> Point {
        let twin = self.twin;
        let place = |edge: usize| (twin.edges_ps[edge] - at.arrival_ps) / twin.sigma_ps;
        let part = |edge: usize| if edge == 0 { 0.0 } else { normal_cdf(place(edge)) };
        let mut sums = ([[0.0; 3]; 3], [0.0; 3]);
        let mut rest = (0.0, 0.0);
        for bin in 0..twin.bins() {
            let (waiting, count) = (self.waiting[bin], self.counts[bin]);
            if place(bin + 1) < -REACH || place(bin) > REACH {
                rest = (rest.0 + count, rest.1 + waiting * twin.width_ps(bin) / twin.bin_ps);
                continue;
            }
            let signal = at.signal * (part(bin + 1) - part(bin));
            let hazard = signal + at.ambient * twin.width_ps(bin);
            let x = match bin {
                0 => {
                    let end = place(1);
                    let density = (-0.5 * end * end).exp() / std::f64::consts::TAU.sqrt();
                    -density / normal_cdf(end).max(1e-300)
                }
                _ => (place(bin) + place(bin + 1)) / 2.0,
            };
            add(&mut sums, count, waiting, hazard, (signal / hazard, x));
        }
        add(&mut sums, rest.0, rest.1, at.ambient * twin.bin_ps, (0.0, 0.0));
        let (mut information, slope) = sums;
        (0..3).for_each(|k| information[k][k] += RIDGE[k]);
        // Ambient light is taken out of the other two.
        let [f1, f2] = [0, 1].map(|k| information[k][2] / information[2][2]);
        let [a, b, c] = [
            information[0][0] - f1 * information[0][2],
            information[0][1] - f1 * information[1][2],
            information[1][1] - f2 * information[1][2],
        ];
        let (u, v) = (slope[0] - f1 * slope[2], slope[1] - f2 * slope[2]);
        let mut steps = [(c * u - b * v) / (a * c - b * b), (a * v - b * u) / (a * c - b * b)];
        while steps[0].abs() >= LONGEST || steps[1].abs() >= 1.0 {
            steps = steps.map(|step| step / 2.0);
        }
        let [along, d] = steps;
        let third = slope[2] / information[2][2] - f1 * along - f2 * d;
        Point {
            arrival_ps: at.arrival_ps + along * twin.sigma_ps,
            signal: at.signal * (1.0 + d + d * d / 2.0),
            ambient: at.ambient * (1.0 + third.clamp(-0.75, 3.0)),
        }
    }
}

/// Adds what a bin says of arrival [sigma], log of the signal, and log of the ambient hazard.
fn add(
    (information, slope): &mut ([[f64; 3]; 3], [f64; 3]),
    count: f64,
    waiting: f64,
    hazard: f64,
    (part, x): (f64, f64),
) {
    let k = if hazard > 1e-9 { hazard / -(-hazard).exp_m1() } else { 1.0 };
    let residual = count * k - waiting * hazard;
    let weight = waiting * hazard * (k - hazard);
    let by = [part * x, part, 1.0 - part];
    for i in 0..3 {
        slope[i] += residual * by[i];
        (0..3).for_each(|j| information[i][j] += weight * by[i] * by[j]);
    }
}

/// The rms error grows by at most a fiftieth of the bound.
fn loses_little(distances_m: &[f64]) {
    let instrument = Instrument::load("kc705", &[]);
    let twin = Twin::of(&instrument);
    let at = |&distance_m: &f64| {
        let mut random = stream(25, Source::Histogram, (1e3 * distance_m) as u64);
        let mut squares = [0.0; 4];
        for place in places(distance_m) {
            let scene = instrument.scene(place, SHOTS).unwrap();
            for _ in 0..8 {
                let histogram = scene.draw(&mut random);
                let own_m = scene.look(&histogram).depth_m();
                let twin_m = twin.distance_m(&histogram);
                let terms =
                    [own_m - distance_m, twin_m - distance_m, own_m - twin_m, scene.bound_m];
                (0..4).for_each(|k| squares[k] += terms[k] * terms[k]);
            }
        }
        let [own, twin, apart] = [0, 1, 2].map(|k| f64::sqrt(squares[k] / squares[3]));
        (distance_m, own, twin, apart)
    };
    let all: Vec<_> = distances_m.par_iter().map(at).collect();
    for (distance_m, own, twin, apart) in all {
        let row =
            format!("{distance_m} m: {own:.4} in integers, {twin:.4} in float, apart {apart:.4}");
        println!("{row}");
        assert!(own - twin < 0.02 && twin < 1.1, "{row}");
    }
}

#[test]
fn the_integers_lose_at_most_a_fiftieth_of_the_bound() {
    loses_little(&DISTANCES_M[1..]);
}

#[test]
fn the_integers_lose_at_most_a_fiftieth_of_the_bound_at_the_nearest_distance() {
    loses_little(&DISTANCES_M[..1]);
}
