//! Dark and lit histograms against the closed form, and the bias that their difference has.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::optics::{BinProbabilities, Hazard};
use tofsim::sim::setup::Setup;

use crate::common::{empty, setup};

use super::{counts, pairs};

/// Level of the tests of distributions; their seeds are fixed.
const LEVEL: f64 = 1e-3;

/// Probabilities of a code in the dark and with the laser.
fn probabilities(setup: &Setup) -> [BinProbabilities; 2] {
    let bins = setup.bins();
    let hazards = [Hazard::dark(&setup.budget), Hazard::new(&setup.budget)];
    hazards.map(|hazard| BinProbabilities::new(&hazard, &bins))
}

/// Chance of a chi-square as large or larger of summed counts.
fn chance(sums: &[i64], codes: &BinProbabilities, shots: f64) -> f64 {
    let missed =
        (shots - sums.iter().sum::<i64>() as f64, 1.0 - codes.of_code().iter().sum::<f64>());
    let cells = sums.iter().zip(codes.of_code()).map(|(&sum, &p)| (sum as f64, p));
    let (mut chi_square, mut count, mut joined) = (0.0, 0.0, (0.0, 0.0));
    for (found, p) in cells.chain([missed]) {
        joined = (joined.0 + found, joined.1 + shots * p);
        if joined.1 >= 25.0 {
            chi_square += f64::powi(joined.0 - joined.1, 2) / joined.1;
            (count, joined) = (count + 1.0, (0.0, 0.0));
        }
    }
    1.0 - ChiSquared::new(count - 1.0).unwrap().cdf(chi_square)
}

#[test]
fn dark_and_lit_frames_are_distributed_as_the_closed_form_says() {
    let folder = empty();
    for (fidelity, frames) in [("cycle", 10), ("shot", 100), ("histogram", 400)] {
        let scene = ["-s", "target.distance_m=0.4", "-s", "target.reflectance=0.5"];
        let count = frames.to_string();
        let how = ["--fidelity", fidelity, "--frames", &count];
        let run = pairs(folder.path(), &[&scene[..], &how].concat());
        let setup = setup("kc705", &["target.distance_m=0.4", "target.reflectance=0.5"]);
        for (kind, codes) in probabilities(&setup).iter().enumerate() {
            let mut sums = vec![0; 256];
            for frame in run["frames"].as_array().unwrap().iter().skip(kind).step_by(2) {
                sums.iter_mut().zip(counts(&frame["histogram"])).for_each(|(sum, n)| *sum += n);
            }
            let chance = chance(&sums, codes, 15_000.0 * f64::from(frames));
            assert!(chance > LEVEL, "{fidelity}, {kind}: {chance}");
        }
    }
}

/// Section 5.2's bias: right of the echo H0 is negative, by the part of the shots that the echo has
/// ended. Closed form, and mean of the frames within four standard deviations of that.
#[test]
fn the_difference_is_negative_right_of_the_echo_as_pile_up_has_it() {
    let folder = empty();
    for (fidelity, frames) in [("cycle", 20), ("shot", 200), ("histogram", 400)] {
        for (irradiance, from_prototype) in [("0.1", -16.0), ("0.2", -9.0), ("0.4", -1.5)] {
            let keys = [
                "target.distance_m=0.6",
                "target.reflectance=0.6",
                "tdc.profile=ideal",
                &format!("ambient.irradiance_w_m2_nm={irradiance}"),
            ];
            let setup = setup("kc705", &keys);
            let [dark, lit] = probabilities(&setup);
            let (arrival_ps, sigma_ps) = (setup.budget.mean_arrival.fs() as f64 / 1e3, 137.0);
            let right = ((arrival_ps + 4.0 * sigma_ps) / 25.0).ceil() as usize..256;
            let [dark, lit] = [&dark, &lit].map(|of| &of.of_code()[right.clone()]);
            let hidden = 1.0 - (-setup.budget.signal_per_shot).exp();
            for (lit, dark) in lit.iter().zip(dark) {
                assert!((lit - dark + dark * hidden).abs() < 2e-3 * dark, "{lit} {dark}");
            }
            let sum = |of: &[f64]| of.iter().sum::<f64>();
            let expected = 15_000.0 * (sum(lit) - sum(dark)) / right.len() as f64;
            assert!((expected - from_prototype).abs() < 0.5, "{expected}");
            let variance =
                15_000.0 * [lit, dark].map(|p| sum(p) * (1.0 - sum(p))).iter().sum::<f64>();
            let deviation = (variance / f64::from(frames)).sqrt() / right.len() as f64;
            let count = frames.to_string();
            let mut options = vec!["--fidelity", fidelity, "--frames", &count];
            keys.iter().for_each(|key| options.extend(["-s", key]));
            let run = pairs(folder.path(), &options);
            let found = run["pairs"]["right_of_echo"].as_f64().unwrap();
            println!(
                "{fidelity} {irradiance}: {found:.2}, expected {expected:.2} +- {deviation:.2}"
            );
            assert!((found - expected).abs() < 4.0 * deviation, "{found}, not {expected}");
            assert!(found < -0.5, "{found}");
        }
    }
}
