//! The other instruments that come by name.

use rayon::prelude::*;

use tofsim::sensor::streams::{Source, stream};

use super::{Instrument, Place, Tally};

/// Over the light of the instrument's own training.
fn at(instrument: &Instrument, distance_m: f64) -> Tally {
    let mut random = stream(27, Source::Histogram, (1e4 * distance_m) as u64);
    let shots = instrument.setup.scenario.firmware.shots_per_frame;
    let mut tally = Tally::default();
    for cell in 0..72 {
        let place = Place {
            distance_m,
            reflectance: 0.2 + 0.075 * (cell % 9) as f64,
            irradiance_w_m2_nm: 0.025 * (cell / 9) as f64,
        };
        let scene = instrument.scene(place, shots).unwrap();
        for _ in 0..15 {
            let histogram = scene.draw(&mut random);
            tally.add(&scene.look(&histogram), distance_m, scene.bound_m);
        }
    }
    tally
}

/// At most 1.15 times the bound, with deviations of its own that are right to a fifth, and believed.
fn is_near_the_bound(name: &str, distances_m: &[f64]) {
    let instrument = Instrument::load(name, &[]);
    let tallies = distances_m.par_iter().map(|&m| (m, at(&instrument, m)));
    for (distance_m, tally) in tallies.collect::<Vec<_>>() {
        let row = tally.row(&format!("{name}, {distance_m} m"));
        println!("{row}");
        assert!(tally.ratio() < 1.15 && (0.85..1.2).contains(&tally.own()), "{row}");
        assert!(tally.raised_part() < 0.02 && tally.far == 0.0, "{row}");
    }
}

#[test]
fn it_is_near_the_bound_of_fine_bins_and_of_an_ecp5() {
    is_near_the_bound("fine", &[0.05, 0.1, 0.2, 0.3]);
    is_near_the_bound("ecp5", &[0.1, 0.2, 0.4, 0.6]);
}

#[test]
fn it_is_near_the_bound_of_a_long_range() {
    is_near_the_bound("long", &[5.0, 9.5]);
}

#[test]
fn it_is_near_the_bound_at_the_near_end_of_a_long_range() {
    is_near_the_bound("long", &[1.0, 2.5]);
}

#[test]
fn it_is_near_the_bound_with_counts_of_few_bits() {
    is_near_the_bound("compact", &[0.15, 0.25, 0.4, 0.6]);
}
