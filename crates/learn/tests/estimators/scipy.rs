//! Splines and peaks against scipy's.

use tofsim::network::Histogram;
use tofsim_learn::estimation::peak_detection::PeakDetection;
use tofsim_learn::estimation::spline::Spline;

use super::SHOTS;

/// The generator that `tests/reference/scipy_spline.py` has as well.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, limit: i64) -> i64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as i64 % limit
    }
}

#[test]
fn splines_on_any_knots_are_scipys() {
    for line in include_str!("../reference/scipy_spline.csv").lines().skip(1) {
        let (seed, expected) = line.split_once(',').unwrap();
        let seed: u64 = seed.parse().unwrap();
        let mut lcg = Lcg(seed);
        let count = 2 + seed % 12;
        let mut knots = vec![lcg.below(1000)];
        (1..count).for_each(|k| knots.push(knots[k as usize - 1] + 1 + lcg.below(2000)));
        let values: Vec<_> = (0..count).map(|_| lcg.below(20_000) - 10_000).collect();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let thousandths = |part: &[i64]| part.iter().map(|&k| k as f64 / 1e3).collect::<Vec<_>>();
        let spline = Spline::new(&thousandths(&knots), &thousandths(&values)).unwrap();
        for expected in expected.split(' ') {
            let place = first - 100 + lcg.below(last - first + 200);
            let (found, expected): (f64, f64) =
                (spline.at(place as f64 / 1e3), expected.parse().unwrap());
            assert!(
                (found - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                "{seed}: {found} {expected}"
            );
        }
    }
}

/// A falling slope with noise, and one to three triangular echoes.
fn sketch(seed: u64) -> Histogram {
    let mut lcg = Lcg(seed);
    let (start, fall) = (lcg.below(400), lcg.below(4));
    let slope = |k: i64| (start - fall * k).max(0);
    let mut counts: Vec<_> = (0..256).map(|k| slope(k) + lcg.below(1 + start / 4)).collect();
    for _ in 0..1 + lcg.below(3) {
        let (centre, height, half) = (lcg.below(256), lcg.below(700), 4 + lcg.below(30));
        for (k, count) in (0..).zip(&mut counts) {
            *count += height * (half - (k - centre).abs()).max(0) / half;
        }
    }
    counts.into_iter().map(|count| count as u16).map(u32::from).collect()
}

#[test]
fn the_peaks_of_a_thousand_histograms_are_scipys() {
    let mut expected = vec![Vec::new(); 1000];
    for line in include_str!("../reference/scipy_peaks.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        expected[row[0] as usize].push([row[1], row[2], row[3]]);
    }
    let detection = PeakDetection::new(SHOTS);
    for (seed, expected) in expected.iter().enumerate() {
        let found =
            detection.peaks(&sketch(seed as u64).into_iter().map(f64::from).collect::<Vec<_>>());
        assert_eq!(found.len(), expected.len(), "{seed}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            let found = [found.location, found.width, found.prominence];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-9, "{seed}: {found} {expected}");
            }
        }
    }
    assert!(expected.iter().filter(|peaks| peaks.len() > 1).count() > 400);
}
