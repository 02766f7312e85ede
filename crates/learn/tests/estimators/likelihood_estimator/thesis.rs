//! The thesis's scenes.

use rayon::prelude::*;

use tofsim::sensor::streams::{Source, stream};

use super::super::{DISTANCES_M, SHOTS};
use super::{Instrument, Place, Tally};

/// Scenes at a distance: 9 irradiances up to 0.4 W/m^2/nm, and 14 reflectances from 0.08 to 0.6.
pub fn places(distance_m: f64) -> impl Iterator<Item = Place> {
    (0..126).map(move |cell| Place {
        distance_m,
        reflectance: 0.08 + 0.04 * (cell % 14) as f64,
        irradiance_w_m2_nm: 0.05 * (cell / 14) as f64,
    })
}

fn at(instrument: &Instrument, distance_m: f64, repeats: usize) -> Tally {
    let mut random = stream(21, Source::Histogram, (1e3 * distance_m) as u64);
    let mut tally = Tally::default();
    for place in places(distance_m) {
        let scene = instrument.scene(place, SHOTS).unwrap();
        for _ in 0..repeats {
            let histogram = scene.draw(&mut random);
            tally.add(&scene.look(&histogram), distance_m, scene.bound_m);
        }
    }
    tally
}

/// At each of the thesis's distances the spread is at most 1.05 times the bound.
fn on_the_bound(repeats: usize) {
    let instrument = Instrument::load("kc705", &[]);
    let all = DISTANCES_M.into_par_iter().map(|m| (m, at(&instrument, m, repeats)));
    for (distance_m, tally) in all.collect::<Vec<_>>() {
        let row = tally.row(&format!("{distance_m} m"));
        println!("{row}");
        assert!(tally.ratio() < 1.05 && tally.mean_mm().abs() < 0.1, "{row}");
        assert!((0.9..1.1).contains(&tally.own()) && tally.raised_part() < 1e-3, "{row}");
        assert_eq!(tally.far, 0.0, "{row}");
    }
}

#[test]
fn it_reaches_the_bound_in_the_thesis_s_scenes() {
    on_the_bound(26);
}

#[test]
#[ignore = "long: ./check --full"]
fn it_reaches_the_bound_in_many_histograms_of_the_thesis_s_scenes() {
    on_the_bound(260);
}
