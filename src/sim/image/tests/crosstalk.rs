//! Tests of crosstalk between the pixels of a row: all of them see the same avalanches of the row.

use super::*;
use crate::firmware::tof_top::TofTop;
use crate::kernel::Time;
use crate::sim::device::{Off, SignalProbe};

const CROSSTALK: &str = "spad.crosstalk_probability=0.3";

/// A row of five pixels of which none sees anything, in shots that the laser does not fire in.
const DARK: [&str; 8] = [
    "array.rows=2",
    "array.columns=5",
    "firmware.shots_per_frame=20000",
    "firmware.laser_freq=3",
    "firmware.laser_en=false",
    "ambient.irradiance_w_m2_nm=0",
    "target.reflectance=0",
    "estimator.kind=centroid",
];

/// Arrivals that are of no other shot: some ns after the arming, and before the reset [fs].
const IN_SHOT: std::ops::Range<i64> = 8_000_000..40_000_000;

/// A file of dark rates: one pixel of the second row is hot, and the others have no dark counts.
fn hot(folder: &tempfile::TempDir, column: usize) -> String {
    let of_pixel = |place: usize| {
        let rate_hz = if place == 5 + column { 1e7 } else { 0.0 };
        format!("{},{},{rate_hz}\n", place / 5, place % 5)
    };
    let lines: String = (0..10).map(of_pixel).collect();
    let path = folder.path().join(format!("{column}.csv"));
    std::fs::write(&path, format!("row,output,rate_hz\n{lines}")).unwrap();
    format!("spad.dark_file={}", path.display())
}

fn shots(setup: &Setup, count: u64) -> Vec<Shot> {
    let mut found = Vec::new();
    let mut take = |shot: &Shot| {
        found.push(*shot);
        Ok(())
    };
    simulate(setup, Shots(Stepping::SkipIdle), count, Some(&mut take), None).unwrap();
    found
}

#[test]
fn a_pixel_gives_the_same_alone_in_every_stepping_and_on_any_number_of_threads() {
    for mode in ["firmware.mode=0", "firmware.mode=1"] {
        let array = array(&["array.columns=5", CROSSTALK, mode]);
        let images = |stepping, threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| array.images(Shots(stepping), 3, None, &|_| ())).unwrap()
        };
        let found = images(Stepping::EveryCycle, 1);
        for (stepping, threads) in STEPPINGS.into_iter().zip([3, 2, 3]) {
            let pixels = images(stepping, threads);
            assert_eq!(frames(&pixels), frames(&found), "{mode} {stepping:?}");
            for (place, pixel) in pixels.iter().enumerate() {
                let setup = array.pixel(place / 5, place % 5);
                let alone = simulate(&setup, Shots(stepping), 3, None, None).unwrap();
                assert_eq!(alone.frames, pixel.frames, "{mode} {stepping:?}");
            }
        }
    }
}

/// Changes of the row's outputs, and of the pixel's own.
#[derive(Default)]
struct Outputs {
    now: u64,
    row: Vec<(Time, u64)>,
    own: Vec<(Time, bool)>,
}

impl SignalProbe for Outputs {
    const ON: bool = true;

    fn outputs(&mut self, outputs: u64) {
        self.now = outputs;
    }

    fn sample(&mut self, now: Time, top: &TofTop) {
        if self.row.last().is_none_or(|last| last.1 != self.now) {
            self.row.push((now, self.now));
        }
        if self.own.last().is_none_or(|last| last.1 != top.pins.tdc_stop) {
            self.own.push((now, top.pins.tdc_stop));
        }
    }
}

#[test]
fn every_pixel_of_a_row_sees_the_same_row_and_has_its_own_output_on_the_tdc() {
    for mode in [
        &["firmware.mode=0"][..],
        &["firmware.mode=1", "spad.dead_time_ns=30"],
        &["firmware.mode=0", "spad.afterpulse_probability=0.5"],
    ] {
        let keys = ["array.columns=5", CROSSTALK, "spad.pdp=8e-3"];
        let array = array(&[&keys, mode].concat());
        let seen = |row, column| {
            let (setup, mut outputs) = (array.pixel(row, column), Outputs::default());
            let mut device = setup.device();
            device.power_up(&mut outputs, &mut Off);
            (0..1000).for_each(|_| device.step(&setup.params, &mut outputs, &mut Off));
            outputs
        };
        let mut rows = Vec::new();
        for row in 0..2 {
            let first = seen(row, 0).row;
            for column in 0..5 {
                let Outputs { row: all, own, .. } = seen(row, column);
                assert_eq!(all, first, "{mode:?} {row},{column}");
                let mut of_column: Vec<_> =
                    all.iter().map(|(at, outputs)| (*at, outputs >> column & 1 == 1)).collect();
                of_column.dedup_by_key(|change| change.1);
                assert_eq!(own, of_column, "{mode:?} {row},{column}");
                assert!(own.len() > 4, "{mode:?} {row},{column}: {}", own.len());
            }
            rows.push(first);
        }
        assert_ne!(rows[0], rows[1], "rows have random numbers of their own");
    }
}

#[test]
fn a_hot_pixel_sets_off_those_beside_it_at_the_same_instant_and_by_their_distance() {
    let (folder, p) = (tempfile::tempdir().unwrap(), 0.3f64);
    for hot_column in [0, 3] {
        let array = of_keys(&[&DARK, &[CROSSTALK, &hot(&folder, hot_column)]]);
        let of_row = |row: usize| [0, 1, 2, 3, 4].map(|column| shots(&array.pixel(row, column), 1));
        assert!(
            of_row(0).iter().flatten().all(|shot| shot.arrival_fs.is_none()),
            "no row is joined"
        );
        let row = of_row(1);
        let arrival = |shot: &Shot| shot.arrival_fs.filter(|fs| IN_SHOT.contains(fs));
        let hits = |column: usize| row[column].iter().filter_map(arrival);
        let of_hot = hits(hot_column).count() as f64;
        assert!(of_hot > 5000.0, "{of_hot}");
        for column in 0..5usize {
            let chance = p.powi(column.abs_diff(hot_column) as i32);
            let (found, expected) = (hits(column).count() as f64, of_hot * chance);
            let allowed = 4.0 * (expected * (1.0 - chance)).sqrt();
            assert!((found - expected).abs() <= allowed, "{column}: {found} of {expected}");
            for (own, hot) in row[column].iter().zip(&row[hot_column]) {
                let is_its = arrival(own).is_none() || arrival(own) == arrival(hot);
                assert!(is_its, "{column}: {own:?} {hot:?}");
            }
        }
        if hot_column == 3 {
            let both =
                |shot: usize| [2, 4].map(|column: usize| arrival(&row[column][shot]).is_some());
            let together = (0..row[0].len()).filter(|shot| both(*shot) == [true; 2]).count() as f64;
            let expected = of_hot * p * p;
            assert!((together - expected).abs() < 4.0 * expected.sqrt(), "sides are independent");
        }
    }
}

#[test]
fn a_pixel_keeps_its_photons_when_crosstalk_is_switched_on() {
    let of = |probability: &str| {
        let key = format!("spad.crosstalk_probability={probability}");
        let faint = ["spad.pdp=8e-5", "firmware.shots_per_frame=600"];
        let array = array(&[&faint[..], &["array.columns=5", &key]].concat());
        array.images(Shots(Stepping::SkipIdle), 3, None, &|_| ()).unwrap()
    };
    let (none, hardly_any, some) = (of("0"), of("1e-12"), of("0.3"));
    assert_eq!(frames(&none), frames(&hardly_any));
    let hits = |pixels: &[Pixel]| {
        pixels.iter().flat_map(|pixel| &pixel.frames).map(|frame| frame.hits).sum::<u64>()
    };
    let ratio = hits(&some) as f64 / hits(&none) as f64;
    // Chances along the row add up: 1.43 for a pixel at its end, 1.78 in its middle.
    assert!((1.45..1.75).contains(&ratio), "{ratio}");
}

#[test]
fn histograms_of_joined_pixels_are_not_drawn_and_nothing_is_expected_of_them() {
    let joined = array(&[CROSSTALK]);
    let error = joined.images(Histograms, 1, None, &|_| ()).unwrap_err().to_string();
    let said = "spad.crosstalk_probability = 0.3: expected 0 for --fidelity histogram";
    assert!(error.contains(said), "{error}");
    assert_eq!(Expected::of(&joined.pixel(0, 0)).signal_hits, None);
    let column = array(&["array.columns=1", CROSSTALK]);
    assert!(column.images(Histograms, 1, None, &|_| ()).is_ok(), "rows of one pixel");
}
