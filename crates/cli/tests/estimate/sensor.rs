//! Histograms that are not the firmware's, and depths that nobody stands for.

use std::path::Path;

use serde_json::Value;

use crate::common::{csv, empty, json, output, refused};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/estimate/cases/");

fn case(name: &str) -> String {
    format!("{CASES}{name}")
}

/// Notes of a run.
fn notes(found: &Value) -> Vec<String> {
    let notes = found["notes"].as_array().unwrap().iter();
    notes.map(|note| format!("{}: {}", note["key"].as_str().unwrap(), note["text"])).collect()
}

#[test]
fn a_depth_that_the_second_opinion_does_not_share_has_a_note() {
    let folder = empty();
    let folder = folder.path();
    let write = |name: &str, counts: &[u32]| {
        std::fs::write(folder.join(name), csv(&counts.to_vec())).unwrap()
    };
    write("zeros.csv", &[0; 256]);
    let far = ["run", "-s", "target.distance_m=0.8", "--fidelity", "shot", "--json"];
    let counts = json(folder, &far)["frames"][0]["histogram"].clone();
    write("far.csv", &serde_json::from_value::<Vec<u32>>(counts).unwrap());
    let many = case("c13_more_hits_than_shots.csv");
    for (file, text) in [
        ("zeros.csv", "rejects histogram 0: no echo"),
        ("far.csv", "in histogram 0: 0.1521 m against 0.7995 m"),
        (&many, "more than its shots"),
    ] {
        let found = json(folder, &["estimate", "--json", file]);
        let notes = notes(&found);
        assert!(notes.iter().any(|note| note.contains(text)), "{file}: {notes:?}");
        assert_eq!(output(folder, &["--strict", "estimate", file]).status.code(), Some(2));
    }
    let fine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stimuli/histograms/kc705.csv");
    let found = json(folder, &["estimate", "--json", fine]);
    assert_eq!(notes(&found), [""; 0]);
    assert_eq!(found["histograms"][0]["second_opinion"]["valid"], true);
}

#[test]
fn the_estimator_is_the_one_that_the_scenario_chooses() {
    let folder = empty();
    let fine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stimuli/histograms/kc705.csv");
    for (kind, name) in
        [("network", "network"), ("centroid", "centroid"), ("likelihood", "likelihood_estimator")]
    {
        let key = format!("estimator.kind={kind}");
        let own = json(folder.path(), &["estimate", "--json", fine, "-s", &key]);
        let other = json(folder.path(), &["estimate", "--json", fine, "--estimator", name]);
        let row = &own["histograms"][0];
        assert_eq!(row["estimator"], name);
        for field in ["depth_m", "sigma_m", "valid", "status"] {
            assert_eq!(row[field], other["histograms"][0]["estimates"][0][field], "{field}");
        }
        assert_eq!(row.get("l1_in").is_some(), kind == "network");
    }
}

#[test]
fn a_sensor_of_sixty_four_bins_comes_to_a_depth_in_a_step_or_two() {
    let folder = empty();
    let folder = folder.path();
    let file = case("c05_64_bins.csv");
    let error = refused(folder, &["estimate", &file]);
    assert!(
        error.contains("bins = 64: expected 256 as tdc.bins of scenario kc705 says"),
        "{error}"
    );
    assert!(error.contains("--bin-ps"), "{error}");
    let found = json(folder, &["estimate", "--json", &file, "--bin-ps", "100"]);
    let row = &found["histograms"][0];
    assert_eq!((&row["estimator"], &row["valid"]), (&"likelihood".into(), &true.into()));
    assert!(row["sigma_m"].as_f64().unwrap() > 0.0);
    assert_eq!(found["sensor"]["bins"], 64);
    let keys = ["firmware.shots_per_frame", "laser.pulse_sigma_ps"];
    assert!(notes(&found).iter().zip(keys).all(|(note, key)| note.starts_with(key)));
    let said = ["-s", "firmware.shots_per_frame=30000", "-s", "laser.pulse_sigma_ps=137"];
    let told =
        json(folder, &[&["estimate", "--json", &file, "--bin-ps", "100"], &said[..]].concat());
    assert_eq!(notes(&told), [""; 0]);
    assert_eq!(told["histograms"][0]["depth_m"], row["depth_m"]);

    let error = refused(folder, &["estimate", &file, "--bin-ps", "100", "--estimator", "centroid"]);
    assert!(error.contains("--estimator: centroid: it is for 256 bins"), "{error}");
    for (args, expected) in
        [(["--bin-ps", "0"], "1 to 1e6 ps"), (["--bin-ps", "nan"], "1 to 1e6 ps")]
    {
        assert!(refused(folder, &[&["estimate", &file], &args[..]].concat()).contains(expected));
    }
}

/// A histogram of that many bins with an echo of the thesis's pulse at an arrival, and even ambient light.
fn echo(bins: usize, bin_ps: f64, arrival_ps: f64) -> Vec<u32> {
    let density = |k: usize| {
        let z = ((k as f64 + 0.5) * bin_ps - arrival_ps) / 137.0;
        20.0 + 4000.0 * bin_ps / 137.0 * (-0.5 * z * z).exp() / 2.5066
    };
    (0..bins).map(|k| density(k).round() as u32).collect()
}

#[test]
fn bins_of_any_number_width_and_begin_give_the_depth_of_their_echo() {
    let folder = empty();
    let folder = folder.path();
    let told = ["-s", "firmware.shots_per_frame=16000000", "-s", "laser.pulse_sigma_ps=137"];
    for (bins, bin_ps, first_ps) in [(50, 100.0, 0.0), (100, 55.0, 1000.0), (999, 25.0, 0.0)] {
        let arrival_ps = 2668.5;
        let counts = echo(bins, bin_ps, arrival_ps - first_ps);
        let rows = counts
            .iter()
            .enumerate()
            .map(|(k, count)| format!("{},{count}\n", 1e-3 * (first_ps + k as f64 * bin_ps)));
        let text = format!("time_ns,count\n{}", rows.collect::<String>());
        std::fs::write(folder.join("own.csv"), text).unwrap();
        let found = json(folder, &[&["estimate", "--json", "own.csv"], &told[..]].concat());
        let depth_m = found["histograms"][0]["depth_m"].as_f64().unwrap();
        assert!((depth_m - 0.4).abs() < 1e-3, "{bins} bins: {depth_m}");
        assert_eq!(found["sensor"]["first_bin_ps"], first_ps);
    }
    let uneven = "time_ns,count\n0,1\n0.1,2\n0.3,9\n0.4,1\n";
    std::fs::write(folder.join("uneven.csv"), uneven).unwrap();
    let error = refused(folder, &["estimate", "uneven.csv"]);
    assert!(error.contains("uneven.csv:3:1: time_ns = 0.1: expected 0.133333"), "{error}");
    std::fs::write(folder.join("one.csv"), "time_ns,count\n0,1\n").unwrap();
    assert!(refused(folder, &["estimate", "one.csv"]).contains("two bins"));
    assert!(Path::new(&case("c05_64_bins.csv")).exists());
}

#[test]
fn the_pulse_of_a_sensor_is_calibrated_from_its_histograms() {
    let folder = empty();
    let folder = folder.path();
    let files = ["a.csv", "b.csv"];
    for (file, arrival_ps) in files.iter().zip([2668.5, 3300.0]) {
        let rows: String = echo(100, 55.0, arrival_ps).iter().map(|n| format!("{n}\n")).collect();
        std::fs::write(folder.join(file), rows).unwrap();
    }
    let calibrate = [&["calibrate", "pulse", "--json"], &files[..]].concat();
    let told = ["--bin-ps", "55", "-s", "firmware.shots_per_frame=16000000"];
    let found = json(folder, &[&calibrate[..], &told].concat());
    let pulses = found["pulses"].as_array().unwrap();
    let gaussian = pulses.iter().find(|pulse| pulse["shape"] == "gaussian").unwrap();
    let sigma_ps = gaussian["sigma_ps"].as_f64().unwrap();
    assert!((sigma_ps - 137.0).abs() < 2.0, "{found}");
    let error = refused(folder, &calibrate);
    assert!(error.contains("a.csv: bins = 100: expected 256 as tdc.bins of scenario"), "{error}");
}

#[test]
fn a_csv_file_is_read_as_spreadsheets_and_scripts_write_it() {
    let folder = empty();
    let folder = folder.path();
    let counts = echo(64, 100.0, 2668.5);
    let table = |row: &dyn Fn(usize, u32) -> String| {
        counts.iter().enumerate().map(|(k, count)| row(k, *count)).collect::<String>()
    };
    let bins = table(&|k, count| format!("{k},{count}\n"));
    let width = ["--bin-ps", "100"];
    for (name, text, width) in [
        ("header", format!("bin,count\n{bins}"), &width[..]),
        ("none", bins.clone(), &width),
        ("quotes", format!("\"bin\",\"count\"\n{bins}"), &width),
        ("counts", table(&|_, count| format!("{count}\n")), &width),
        ("spaces", table(&|k, count| format!(" {k:3}  {count}\n")), &width),
        ("numpy", table(&|k, count| format!("{k:.3e}\t{count:.8e}\n", k = k as f64)), &width),
        ("mac", format!("bin,count\r{}", bins.replace('\n', "\r")), &width),
        ("ps", format!("time_ps;count\n{}", table(&|k, n| format!("{}00;{n}\n", k))), &[]),
        (
            "ns",
            format!("time_ns;count\n{}", table(&|k, n| format!("{},{};{n}\n", k / 10, k % 10))),
            &[],
        ),
        (
            "windows",
            format!(
                "\u{feff}time_ns, count\r\n{}",
                table(&|k, n| format!("{},{n}\r\n", k as f64 / 10.0))
            ),
            &[],
        ),
    ] {
        let file = format!("{name}.csv");
        std::fs::write(folder.join(&file), text).unwrap();
        let found = json(folder, &[&["estimate", "--json", &file][..], width].concat());
        assert_eq!(found["sensor"]["bins"], 64, "{name}");
        assert_eq!(found["sensor"]["bin_ps"], 100.0, "{name}");
        let depth_m = found["histograms"][0]["depth_m"].as_f64().unwrap();
        assert!((depth_m - 0.4).abs() < 1e-3, "{name}: {depth_m}");
    }
    std::fs::write(folder.join("wide.csv"), "time_ns,count\n0,1\n1,2\n").unwrap();
    std::fs::write(folder.join("narrow.csv"), "time_ns,count\n0,1\n0.5,2\n").unwrap();
    let error = refused(folder, &["estimate", "wide.csv", "narrow.csv"]);
    let expected =
        "narrow.csv: bins = 2 of 500 ps from 0 ps on: expected 2 of 1000 ps from 0 ps on";
    assert!(error.contains(expected), "{error}");
    for (text, expected) in [
        ("1,5\n2,6\n", "own.csv:1:1: bin = 1: expected 0: the numbers of all bins"),
        ("0,5\n0.1,6\n", "own.csv:2:1: bin = 0.1: expected 1"),
        ("0,5\n0.1,6\n", "times need the header `time_ns,count` or `time_ps,count`"),
        ("bin,count\n0,5\n1,2.5\n", "own.csv:3:3: count = 2.5: expected a whole number"),
        ("time_ps,count\n0,5\n1,-1\n", "own.csv:3:3: count = -1: expected a whole number"),
        (
            "time_us,count\n0,5\n",
            "own.csv:1:1: time_us,count: expected one of the headers `bin,count`,",
        ),
    ] {
        std::fs::write(folder.join("own.csv"), text).unwrap();
        let error = refused(folder, &["estimate", "own.csv", "--bin-ps", "100"]);
        assert!(error.contains(expected), "{error}");
    }
}
