//! The whole chain, photons through firmware to metres, against the closed form and the network in
//! floating point.

use std::thread;

use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Hazard};
use tofsim::sensor::streams::{Source, stream};
use tofsim::sim::setup::Setup;
use tofsim::sim::{Run, Stepping};

use crate::common;

const DISTANCES_M: [f64; 6] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
const REFLECTANCES: [f64; 2] = [0.08, 0.60];
/// Error that fixed point may add, in mean and in spread [m].
const FIXED_POINT_M: f64 = 0.3e-3;

#[derive(Clone, Copy)]
struct Depths {
    mean_m: f64,
    sd_m: f64,
    count: f64,
}

impl Depths {
    fn of(depths: &[f64]) -> Self {
        let count = depths.len() as f64;
        let mean_m = depths.iter().sum::<f64>() / count;
        let squares: f64 = depths.iter().map(|depth| (depth - mean_m).powi(2)).sum();
        Depths { mean_m, sd_m: (squares / (count - 1.0)).sqrt(), count }
    }

    fn error_of_mean_m(&self) -> f64 {
        self.sd_m / self.count.sqrt()
    }

    fn error_of_sd_m(&self) -> f64 {
        self.sd_m / (2.0 * (self.count - 1.0)).sqrt()
    }
}

fn probabilities(setup: &Setup) -> BinProbabilities {
    BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins())
}

fn scene(distance_m: f64, reflectance: f64, more: &[&str]) -> Setup {
    let distance = format!("target.distance_m={distance_m}");
    let reflectance = format!("target.reflectance={reflectance}");
    common::setup("kc705", &[&[distance.as_str(), reflectance.as_str()], more].concat())
}

/// Fifty seeds through the firmware.
fn chain(distance_m: f64, reflectance: f64) -> Depths {
    let depths = (0..50).map(|seed| {
        let setup = scene(distance_m, reflectance, &[&format!("seed={seed}")]);
        common::frames(&setup, 1)[0].depth_m()
    });
    Depths::of(&depths.collect::<Vec<_>>())
}

/// The network in floating point on histograms drawn from the closed form.
fn closed_form(distance_m: f64, reflectance: f64) -> Depths {
    let setup = scene(distance_m, reflectance, &[]);
    let (probabilities, float) = (probabilities(&setup), setup.network.twin());
    let mut rng = stream(2026, Source::Avalanche, (distance_m * 1e4 + reflectance * 1e2) as u64);
    let shots = setup.scenario.firmware.shots_per_frame;
    let depths = (0..2000).map(|_| {
        let drawn = probabilities.draw(shots, &mut rng);
        let drawn: Histogram = drawn.into_iter().map(|count| count as u32).collect();
        float.forward(&drawn)
    });
    Depths::of(&depths.collect::<Vec<_>>())
}

/// Prints the table of docs/accuracy.md:
/// `cargo test -p tofsim --test simulator whole_chain -- --nocapture`.
#[test]
fn fifty_seeds_agree_with_the_float_network_on_the_closed_form() {
    println!(
        "| d [m] | rho | chain: mean error [mm] | 2σ [mm] | closed form, float: mean error [mm] | 2 sd [mm] |"
    );
    println!("|---|---|---|---|---|---|");
    for reflectance in REFLECTANCES {
        for distance_m in DISTANCES_M {
            let (chain, float) = thread::scope(|scope| {
                let chain = scope.spawn(|| chain(distance_m, reflectance));
                let float = closed_form(distance_m, reflectance);
                (chain.join().unwrap(), float)
            });
            let mm = |depths: &Depths| {
                let error_mm = (depths.mean_m - distance_m) * 1e3;
                let of_mean_mm = depths.error_of_mean_m() * 1e3;
                format!("{error_mm:+.2} +- {of_mean_mm:.2} | {:.2}", 2e3 * depths.sd_m)
            };
            println!("| {distance_m} | {reflectance} | {} | {} |", mm(&chain), mm(&float));
            let mean_error = chain.error_of_mean_m().hypot(float.error_of_mean_m());
            let mean_off = (chain.mean_m - float.mean_m).abs();
            assert!(mean_off <= 3.0 * mean_error + FIXED_POINT_M, "mean off by {mean_off} m");
            let sd_error = chain.error_of_sd_m().hypot(float.error_of_sd_m());
            let sd_off = (chain.sd_m - float.sd_m).abs();
            assert!(sd_off <= 3.0 * sd_error + FIXED_POINT_M, "sd off by {sd_off} m");
        }
    }
}

/// Chi-square of the sum of many frames against the closed form; bins of few hits are joined.
fn p_value(setup: &Setup, frames: u64) -> f64 {
    let expected = probabilities(setup);
    let total = (frames * setup.scenario.firmware.shots_per_frame) as f64;
    let mut observed = [0u64; 256];
    // Bit by bit those of the clocks, as `fast_ways` and `stepping` test.
    let run = Run::new(setup).stepping(Stepping::LeapShots);
    for frame in run.frames(frames).unwrap() {
        observed.iter_mut().zip(&frame.histogram).for_each(|(sum, &count)| *sum += count as u64);
    }
    let hits: u64 = observed.iter().sum();
    let mut cells: Vec<(f64, f64)> = vec![(0.0, 0.0)];
    let rest = 1.0 - expected.of_code().iter().sum::<f64>();
    let codes = observed.iter().zip(expected.of_code()).map(|(&o, p)| (o as f64, p * total));
    for (seen, due) in codes.chain([(total - hits as f64, rest * total)]) {
        if cells.last().unwrap().1 >= 25.0 {
            cells.push((0.0, 0.0));
        }
        let cell = cells.last_mut().unwrap();
        *cell = (cell.0 + seen, cell.1 + due);
    }
    let chi_square: f64 = cells.iter().map(|(seen, due)| (seen - due).powi(2) / due).sum();
    1.0 - ChiSquared::new(cells.len() as f64 - 1.0).unwrap().cdf(chi_square)
}

/// Level 0.1 % for each of six scenes, seed 2026.
#[test]
fn two_hundred_frames_agree_with_the_closed_form() {
    let scenes = [(0.5, 0.34), (0.1, 0.6), (0.6, 0.08)];
    for profile in ["ideal", "uniform"] {
        let profile = format!("tdc.profile={profile}");
        thread::scope(|scope| {
            for (distance_m, reflectance) in scenes {
                let profile = &profile;
                scope.spawn(move || {
                    let setup = scene(distance_m, reflectance, &[profile, "seed=2026"]);
                    let p = p_value(&setup, 200);
                    println!("{profile}, {distance_m} m, {reflectance}: p = {p:.4}");
                    assert!(p > 0.001, "{profile}, {distance_m} m, {reflectance}: p = {p}");
                });
            }
        });
    }
}

/// Section 4.2's bin sizes, and one or 40 SPADs on the TDC: level 0.1 % for each, 40 frames.
#[test]
fn every_width_of_bin_and_number_of_spads_agrees_with_the_closed_form() {
    thread::scope(|scope| {
        for on_tdc in [1, 40] {
            scope.spawn(move || {
                for bin_ps in [10, 25, 50, 100, 250, 500] {
                    let keys = [
                        format!("tdc.bin_ps={bin_ps}"),
                        format!("spad.on_tdc={on_tdc}"),
                        "tdc.coarse_bits=5".to_owned(),
                        "firmware.laser_periods=[30]".to_owned(),
                        "firmware.laser_freq=0".to_owned(),
                        "firmware.drain_cycles=40".to_owned(),
                        "seed=2026".to_owned(),
                    ];
                    let setup = scene(0.3, 0.34, &keys.each_ref().map(String::as_str));
                    let p = p_value(&setup, 40);
                    println!("{bin_ps} ps, {on_tdc} SPADs: p = {p:.4}");
                    assert!(p > 0.001, "{bin_ps} ps, {on_tdc} SPADs: p = {p}");
                }
            });
        }
    });
}

/// A range gate moves the codes and nothing else.
#[test]
fn with_a_range_gate_the_first_bin_is_later() {
    let histogram = |first_ps: &str| {
        let gate = format!("tdc.first_bin_ps={first_ps}");
        let keys = ["tdc.profile=ideal", "firmware.shots_per_frame=20000", gate.as_str()];
        common::frames(&scene(0.4, 0.6, &keys), 1).remove(0).histogram
    };
    let (open, gated) = (histogram("0"), histogram("2500"));
    assert!(gated[..156].iter().sum::<u32>() > 500);
    assert_eq!(gated[..156], open[100..]);
    assert!(gated[160..].iter().any(|&count| count > 0), "light past 6.4 ns");
}
