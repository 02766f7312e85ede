//! One echo, in which two are not to be seen, and where they are nevertheless.

use rayon::prelude::*;

use tofsim::network::Histogram;
use tofsim::sensor::streams::{Source, stream};
use tofsim::sim::estimates::likelihood::estimate;

use super::super::super::{DISTANCES_M, SHOTS};
use super::super::Instrument;
use super::super::thesis::places;
use super::is_unlikely;
use super::joint::likelihood;

/// How many of those histograms of an instrument are so: at six distances, of 126 scenes each, `repeats` of each.
fn count(
    instrument: &Instrument,
    repeats: usize,
    is: impl Fn(&Histogram) -> bool + Send + Sync,
) -> usize {
    let at = |distance_m: f64| {
        let mut random = stream(31, Source::Histogram, (1e3 * distance_m) as u64);
        let of = |place| {
            let scene = instrument.scene(place, SHOTS).unwrap();
            (0..repeats).filter(|_| is(&scene.draw(&mut random))).count()
        };
        places(distance_m).map(of).sum::<usize>()
    };
    DISTANCES_M.into_par_iter().map(at).sum()
}

/// How many of 756 histograms of such an instrument show two echoes to one that is told 137 ps.
fn seen_as_two(set: &[&str]) -> usize {
    let likelihood = likelihood(&Instrument::load("kc705", &[]));
    let seen = count(&Instrument::load("kc705", set), 1, |histogram| {
        let alone = likelihood.fit(histogram).unwrap();
        likelihood.fit_both(histogram, &alone).is_some()
    });
    println!("{set:?}: {seen} of 756");
    seen
}

#[test]
fn no_second_echo_is_found_where_there_is_one_alone() {
    assert_eq!(seen_as_two(&[]), 0);
}

/// This is why an estimate is of one echo.
#[test]
fn a_pulse_that_is_a_tenth_wider_than_told_looks_like_two() {
    assert!(seen_as_two(&["laser.pulse_sigma_ps=152"]) > 100);
    assert_eq!(seen_as_two(&["laser.pulse_sigma_ps=141"]), 0);
}

#[test]
fn a_large_chi_square_is_rare_where_there_is_one_echo() {
    let instrument = Instrument::load("kc705", &[]);
    let (params, bins) = (&instrument.params, instrument.params.fitted());
    let unlikely =
        count(&instrument, 10, |histogram| is_unlikely(&estimate(params, histogram), bins));
    println!("{unlikely} of 7560");
    assert!(unlikely < 60, "{unlikely} of 7560");
}
