//! A chain that is another at each edge: conditions that change within a run, and registers that sample anywhere in
//! their set-up window.

use std::fs;

use tofsim::{Frame, Setup};

use crate::common::{frames, setup};

/// A run of a chain of equal taps whose die is at these temperatures at these times [s, degC].
fn heated(rows: &[(f64, f64)], keys: &[&str]) -> Setup {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("conditions.csv");
    let rows: String = rows.iter().map(|(s, c)| format!("{s:?},{c:?},0\n")).collect();
    fs::write(&path, format!("time_s,temperature_c,supply_mv\n{rows}")).unwrap();
    let file = format!("tdc.conditions={:?}", path.display().to_string());
    let scene =
        ["target.distance_m=0.3", "ambient.irradiance_w_m2_nm=0.02", "target.reflectance=0.05"];
    setup("kc705", &[&scene[..], &["firmware.shots_per_frame=4000", &file], keys].concat())
}

/// Mean of the codes about the echo [bins].
fn echo(frame: &Frame) -> f64 {
    let near = frame.histogram.iter().enumerate().skip(30).take(100);
    let (sum, count) = near.fold((0.0, 0.0), |(sum, count), (bin, &hits)| {
        (sum + bin as f64 * f64::from(hits), count + f64::from(hits))
    });
    sum / count
}

#[test]
fn conditions_that_stand_still_are_those_of_the_keys() {
    let warm = setup(
        "kc705",
        &[
            "target.distance_m=0.3",
            "ambient.irradiance_w_m2_nm=0.02",
            "target.reflectance=0.05",
            "firmware.shots_per_frame=4000",
            "tdc.temperature_c=65",
            "tdc.calibrated_at_c=25",
        ],
    );
    for rows in [&[(0.0, 65.0)][..], &[(0.0, 65.0), (1.0, 65.0)]] {
        let still = heated(rows, &["tdc.calibrated_at_c=25"]);
        assert!(still.disturbance().is_none());
        assert_eq!(frames(&still, 2), frames(&warm, 2));
    }
}

#[test]
fn forty_degrees_in_mid_run_move_the_echo_and_calibrations_bring_it_back() {
    // A frame takes 0.19 ms, and a calibration before it 2.0 ms.
    let once = heated(&[(0.25e-3, 25.0), (0.55e-3, 65.0)], &[]);
    let again = ["tdc.recalibrate_frames=1", "tdc.calibration_hits_log2=15"];
    let repeated = heated(&[(2.5e-3, 25.0), (9e-3, 65.0)], &again);
    let moved = |setup: &Setup| {
        let found: Vec<_> = frames(setup, 5).iter().map(echo).collect();
        found[4] - found[0]
    };
    // The echo comes 2.0 ns after the laser edge and is sampled at 8 ns: an age of 6 ns reads as 6 ns / 1.04.
    let expected = 6.0 * (1.0 - 1.0 / 1.04) / 0.025;
    let found = moved(&once);
    assert!((found - expected).abs() < 0.6, "{found} for {expected}");
    // Calibrations do not see the chain's offset, which grows by 0.04 of 2.23 ns; their hits have a random mean, of
    // 13 ps each.
    let (expected, random) = (0.04 * 2.23 / 0.025, 2f64.sqrt() * 0.013 / 0.025);
    let found = moved(&repeated);
    assert!((found - expected).abs() < 4.0 * random, "{found} for {expected}");
}

#[test]
fn a_window_of_set_up_is_drawn_from_the_seed_and_moves_no_echo() {
    let run = |keys: &[&str]| {
        let scene =
            ["target.distance_m=0.3", "tdc.profile=kintex7", "firmware.shots_per_frame=8000"];
        frames(&setup("kc705", &[&scene[..], keys].concat()), 2)
    };
    let (none, wide) = (run(&[]), run(&["tdc.setup_window_ps=5"]));
    assert_eq!(wide, run(&["tdc.setup_window_ps=5"]));
    assert_ne!(wide, none);
    assert_eq!(run(&["tdc.setup_window_ps=0"]), none);
    for (wide, none) in wide.iter().zip(&none) {
        assert_eq!(wide.hits(), none.hits());
        assert!((echo(wide) - echo(none)).abs() < 0.05, "{} {}", echo(wide), echo(none));
    }
}
