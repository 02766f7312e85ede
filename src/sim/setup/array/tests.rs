//! Tests of what pixels have in common with an instrument of one pixel, and of what each has of its own.

use std::collections::HashSet;
use std::fs;

use super::*;
use crate::kernel::Time;
use crate::scenario;
use crate::sim::run::Run;

fn array(keys: &[&str]) -> ArraySetup {
    let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
    ArraySetup::new(scenario::load("kc705", &keys).unwrap()).unwrap()
}

fn pixels(array: &ArraySetup) -> impl Iterator<Item = Setup> {
    let [rows, columns] = array.size();
    (0..rows * columns).map(move |place| array.pixel(place / columns, place % columns))
}

/// A file with such lines, and the key that names it.
fn file(folder: &tempfile::TempDir, name: &str, key: &str, lines: &[&str]) -> String {
    let path = folder.path().join(name);
    fs::write(&path, lines.join("\n")).unwrap();
    format!("{key}={}", path.display())
}

const SIZE: [&str; 2] = ["array.rows=2", "array.columns=2"];

#[test]
fn the_streams_of_a_pixel_are_its_own_in_an_array_of_any_size() {
    let (small, large) = (array(&SIZE), array(&["array.rows=3", "array.columns=64"]));
    for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        assert_eq!(small.pixel(row, column).seed(), large.pixel(row, column).seed());
    }
    let mut seeds: HashSet<_> = pixels(&large).map(|pixel| pixel.seed()).collect();
    assert!(seeds.iter().all(|seed| *seed <= MOST_SEED));
    let other = array(&[&SIZE[..], &["seed=2"]].concat());
    seeds.extend(pixels(&other).map(|pixel| pixel.seed()));
    assert_eq!(seeds.len(), 3 * 64 + 4);
}

/// The mean code of each of some short frames, less the mean of all.
fn codes(setup: &Setup) -> Vec<f64> {
    let mean = |histogram: &[u32]| {
        let codes = (0u32..).zip(histogram).map(|(code, count)| f64::from(code * count));
        codes.sum::<f64>() / f64::from(histogram.iter().sum::<u32>())
    };
    let frames = Run::new(setup).frames(60).unwrap();
    let codes: Vec<_> = frames.iter().map(|frame| mean(&frame.histogram)).collect();
    let middle = codes.iter().sum::<f64>() / codes.len() as f64;
    codes.iter().map(|code| code - middle).collect()
}

#[test]
fn pixels_of_a_row_share_the_jitter_of_the_laser_and_those_of_other_rows_do_not() {
    let jitter = ["laser.timing_jitter_ps=600", "firmware.shots_per_frame=20"];
    let bright =
        ["target.distance_m=0.4", "ambient.irradiance_w_m2_nm=0", "laser.average_power_w=0.5"];
    let array = array(&[&SIZE[..], &jitter, &bright].concat());
    let codes: Vec<_> = pixels(&array).map(|pixel| codes(&pixel)).collect();
    let correlation = |[one, other]: [usize; 2]| {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let of = |a: usize, b: usize| product(&codes[a], &codes[b]);
        of(one, other) / (of(one, one) * of(other, other)).sqrt()
    };
    for row in [[0, 1], [2, 3]] {
        assert!(correlation(row) > 0.6, "{row:?}: {}", correlation(row));
    }
    for rows in [[0, 2], [0, 3], [1, 2], [1, 3]] {
        assert!(correlation(rows).abs() < 0.4, "{rows:?}: {}", correlation(rows));
    }
}

#[test]
fn an_offset_moves_all_light_of_its_pixel_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let lines = ["row,column,offset_ps", "0,0,0", "1,1,1000", "1,0,-40", "0,1,250.5"];
    let offsets = file(&folder, "offsets.csv", "array.offset_file", &lines);
    let delay = "laser.delay_ps=100";
    let usual = array(&[&SIZE[..], &[delay]].concat());
    let moved = array(&[&SIZE[..], &[delay, &offsets]].concat());
    let offsets_fs = [0, 250_500, -40_000, 1_000_000];
    for ((usual, moved), offset_fs) in pixels(&usual).zip(pixels(&moved)).zip(offsets_fs) {
        let late = |time: Time| Time::from_fs(time.fs().checked_add_signed(offset_fs).unwrap());
        let (usual, moved) = (usual.budget, moved.budget);
        assert_eq!(moved.mean_arrival, late(usual.mean_arrival));
        assert_eq!(moved.target_ends(), usual.target_ends().map(late));
        assert_eq!(moved.flight(), usual.flight());
        assert_eq!(moved.signal_per_shot, usual.signal_per_shot);
        assert_eq!(moved.background_rate_hz(), usual.background_rate_hz());
    }
}

#[test]
fn a_fraction_of_the_window_s_light_is_that_of_its_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let lines = ["row,column,fraction", "1,1,4e-5", "0,0,1e-5", "0,1,0", "1,0,3e-5"];
    let fractions = file(&folder, "fractions.csv", "cover.fraction_file", &lines);
    let found = array(&[&SIZE[..], &[&fractions]].concat());
    let found: Vec<_> = pixels(&found).map(|pixel| pixel.budget.cover_per_shot).collect();
    let even = array(&[&SIZE[..], &["cover.fraction=4e-5"]].concat());
    let even: f64 = pixels(&even).map(|pixel| pixel.budget.cover_per_shot).sum();
    for (found, fraction) in found.into_iter().zip([1e-5, 0.0, 3e-5, 4e-5]) {
        assert!((found - even * fraction / 4e-5).abs() < 1e-9 * even, "{found}");
    }
    let error = |lines: &[&str]| {
        let fractions = file(&folder, "faulty.csv", "cover.fraction_file", lines);
        let keys = [&SIZE[..], &[&fractions]]
            .concat()
            .iter()
            .map(|&key| key.to_owned())
            .collect::<Vec<_>>();
        ArraySetup::new(scenario::load("kc705", &keys).unwrap()).unwrap_err().to_string()
    };
    let found = error(&["row,column,fraction", "0,0,-1e-5"]);
    assert!(
        found.contains("faulty.csv:2:5: fraction = -1e-5: expected a fraction from 0 to 1"),
        "{found}"
    );
    let found = error(&["row,column,fraction", "0,0,1e-5"]);
    assert!(
        found.contains("missing = row 0, column 1: expected a line for each of 2 x 2"),
        "{found}"
    );
}

#[test]
fn a_measured_dark_rate_is_that_of_its_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let lines = ["row,output,rate_hz", "0,0,500", "1,1,0", "1,0,7000", "39,29,1"];
    let rates = file(&folder, "rates.csv", "spad.dark_file", &lines);
    let array = array(&[&SIZE[..], &[&rates, "spad.temperature_c=28"]].concat());
    let found: Vec<_> = pixels(&array).map(|pixel| pixel.budget.dark_rate_hz).collect();
    assert_eq!(found, [1000.0, 200.0, 14_000.0, 0.0], "the second one is not named");
}

#[test]
fn pixels_have_the_hash_of_their_array_which_is_one_of_its_files() {
    let of_all = |array: &ArraySetup| {
        let hash = array.common().hash();
        assert!(pixels(array).all(|pixel| pixel.hash() == hash));
        hash
    };
    let spread = array(&[&SIZE[..], &["spad.dark_spread=0.8"]].concat());
    assert_ne!(of_all(&spread), of_all(&array(&SIZE)));
    let folder = tempfile::tempdir().unwrap();
    let hash = |last_ps: &str, last_hz: &str| {
        let lines = ["row,column,offset_ps", "0,0,0", "0,1,3", "1,0,4", last_ps];
        let offsets = file(&folder, "offsets.csv", "array.offset_file", &lines);
        let lines = ["row,output,rate_hz", "0,0,500", last_hz];
        let rates = file(&folder, "rates.csv", "spad.dark_file", &lines);
        let array = array(&[&SIZE[..], &[&offsets, &rates]].concat());
        of_all(&array)
    };
    let (usual, again) = (hash("1,1,5", "1,1,9"), hash("1,1,5", "1,1,9"));
    assert_eq!(usual, again);
    assert_ne!(hash("1,1,6", "1,1,9"), usual);
    assert_ne!(hash("1,1,5", "1,1,8"), usual);
}

#[test]
fn a_single_pixel_is_an_instrument_of_one_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let lines = ["row,output,rate_hz", "0,0,5e6", "0,15,3e6"];
    let rates = file(&folder, "rates.csv", "spad.dark_file", &lines);
    let view = "array.field_of_view_deg=[10,8]";
    for keys in [&[][..], &[view], &[view, "spad.dark_spread=0.8"], &[view, &rates]] {
        let keys = [keys, &["firmware.shots_per_frame=300"]].concat();
        let (alone, pixel) = (Setup::load("kc705", &keys).unwrap(), array(&keys).pixel(0, 0));
        assert_eq!(pixel.budget, alone.budget);
        assert_eq!((pixel.seed(), pixel.hash()), (alone.seed(), alone.hash()), "{keys:?}");
        let frames = |setup| Run::new(setup).frames(3).unwrap();
        assert_eq!(frames(&pixel), frames(&alone));
    }
}

#[test]
fn an_array_is_no_instrument_of_one_pixel() {
    for [key, value] in [["array.rows", "3"], ["array.columns", "2"]] {
        let error = Setup::load("kc705", &[&format!("{key}={value}")]).unwrap_err().to_string();
        let expected = format!("scenario kc705: {key} = {value}: expected 1 here");
        assert!(error.starts_with(&expected), "{error}");
    }
}

#[test]
fn a_pixel_without_light_says_why_it_has_no_depth() {
    let corner = ["target.offset_x_m=-0.05", "target.length_m=0.02"];
    let array = array(&[&SIZE[..], &corner].concat());
    let keys = |column| array.pixel(0, column).no_depth().map(|note| note.key.clone());
    assert_eq!(keys(0), None);
    assert!(keys(1).is_some());
}
