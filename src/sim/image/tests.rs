//! Tests of images: they are those of each pixel by itself, on any number of threads and in any fidelity.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::ThreadPoolBuilder;

use super::*;
use crate::error::Error;
use crate::scenario;
use crate::sim::Stepping;

use ImageFidelity::{Histograms, Shots};

mod crosstalk;

const STEPPINGS: [Stepping; 3] = [Stepping::EveryCycle, Stepping::SkipIdle, Stepping::LeapShots];

/// The array of a scenario with such keys.
fn of_keys(keys: &[&[&str]]) -> ArraySetup {
    let keys: Vec<_> = keys.concat().into_iter().map(str::to_owned).collect();
    ArraySetup::new(scenario::load("kc705", &keys).unwrap()).unwrap()
}

/// An array of 3 x 2 pixels with a photon in two or three shots each, of a target that is no plane; with further keys.
pub(super) fn array(further: &[&str]) -> ArraySetup {
    let keys = [
        "array.rows=3",
        "array.columns=2",
        "firmware.shots_per_frame=60",
        "spad.pdp=8e-4",
        "target.length_m=0.5",
        "target.width_m=0.5",
        "target.tilt_deg=35",
    ];
    of_keys(&[&keys, further])
}

fn frames(pixels: &[Pixel]) -> Vec<Vec<PixelFrame>> {
    pixels.iter().map(|pixel| pixel.frames.clone()).collect()
}

#[test]
fn images_are_the_same_on_any_number_of_threads() {
    let array = array(&[]);
    for fidelity in [Histograms, Shots(Stepping::LeapShots)] {
        let on = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let done = AtomicU64::new(0);
            let count = |frames| _ = done.fetch_add(frames, Ordering::Relaxed);
            let images = pool.install(|| array.images(fidelity, 4, None, &count)).unwrap();
            assert_eq!((images.len(), done.into_inner()), (6, 24));
            frames(&images)
        };
        let found = on(1);
        assert_eq!(found, on(3));
        assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "each has photons of its own");
    }
}

#[test]
fn a_pixel_gives_the_same_alone_and_in_every_stepping() {
    let array = array(&[]);
    let images = STEPPINGS.map(|stepping| array.images(Shots(stepping), 3, None, &|_| ()).unwrap());
    for (stepping, pixels) in STEPPINGS.iter().zip(&images) {
        assert_eq!(frames(pixels), frames(&images[0]), "{stepping:?}");
        for (place, pixel) in pixels.iter().enumerate() {
            let setup = array.pixel(place / 2, place % 2);
            let alone = simulate(&setup, Shots(*stepping), 3, None, None).unwrap();
            assert_eq!((&alone.frames, alone.expected), (&pixel.frames, pixel.expected));
        }
    }
}

#[test]
fn drawn_histograms_have_the_hits_of_shots_and_those_that_are_expected() {
    let count = 600;
    let setup = array(&[]).pixel(1, 1);
    let hits = |fidelity| {
        let pixel = simulate(&setup, fidelity, count, None, None).unwrap();
        let hits = || pixel.frames.iter().map(|frame| frame.hits as f64);
        let mean = hits().sum::<f64>() / count as f64;
        let square = hits().map(|hits| (hits - mean).powi(2)).sum::<f64>() / (count - 1) as f64;
        let Expected { signal_hits, ambient_hits, .. } = pixel.expected;
        let expected = signal_hits.unwrap() + ambient_hits.unwrap();
        // The squared standard error of the mean.
        let error2 = square / count as f64;
        assert!((mean - expected).abs() < 4.0 * error2.sqrt(), "{mean} for {expected}");
        (mean, error2)
    };
    let ((drawn, of_drawn), (shot, of_shot)) = (hits(Histograms), hits(Shots(Stepping::LeapShots)));
    assert!(of_drawn > 0.0 && of_shot > 0.0);
    assert!((drawn - shot).abs() < 4.0 * (of_drawn + of_shot).sqrt(), "{drawn}, {shot}");
}

#[test]
fn rows_of_a_tilted_plane_are_expected_nearer_from_top_to_bottom() {
    let images = array(&[]).images(Histograms, 1, None, &|_| ()).unwrap();
    let radial_m: Vec<_> = images.iter().map(|pixel| pixel.expected.radial_m.unwrap()).collect();
    assert!(radial_m.windows(3).all(|row| row[0] > row[2] + 0.01), "{radial_m:?}");
}

#[test]
fn a_stop_ends_images_without_a_result() {
    let array = array(&[]);
    for fidelity in [Histograms, Shots(Stepping::SkipIdle), Shots(Stepping::LeapShots)] {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let after_one = |frames| {
            done.fetch_add(frames, Ordering::Relaxed);
            stop.store(true, Ordering::Relaxed);
        };
        let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let found = pool.install(|| array.images(fidelity, 2, Some(&stop), &after_one));
        assert!(matches!(found, Err(Error::Interrupted)), "{fidelity:?}");
        assert_eq!(done.into_inner(), 2);
        let found = simulate(&array.pixel(0, 0), fidelity, 2, None, Some(&stop));
        assert!(matches!(found, Err(Error::Interrupted)), "{fidelity:?}");
    }
}

#[test]
fn the_median_lies_between_the_two_in_the_middle() {
    let of = |values: &[f64]| ends_and_median(values.iter().copied());
    assert_eq!(of(&[3.0, 1.0, 2.0]), Some([1.0, 2.0, 3.0]));
    assert_eq!(of(&[4.0, 1.0, 2.0, 3.0]), Some([1.0, 2.5, 4.0]));
    assert_eq!(of(&[]), None);
}

#[test]
fn sigma_holds_where_each_column_has_a_chain_of_its_own() {
    let keys = [
        "array.rows=2",
        "array.columns=6",
        "array.chains_file=../chains/columns.csv",
        "tdc.profile=kintex7",
        "estimator.kind=likelihood",
        "target.reflectance=0.5",
        "ambient.irradiance_w_m2_nm=0.01",
        "laser.average_power_w=0.0023",
        "lens.area_m2=9.5e-4",
    ];
    let pixels = of_keys(&[&keys]).images(Histograms, 60, None, &|_| ()).unwrap();
    let mut squares = Vec::new();
    for pixel in &pixels {
        let true_m = pixel.expected.radial_m.unwrap();
        for frame in pixel.frames.iter().filter(|frame| frame.valid) {
            squares.push(((frame.radial_m - true_m) / frame.sigma_m.unwrap()).powi(2));
        }
    }
    assert!(squares.len() >= 12 * 60 - 3, "{} are valid", squares.len());
    let ratio = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}
