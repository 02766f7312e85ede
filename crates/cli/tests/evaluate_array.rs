//! Evaluations over the pixels of an array.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty, files, json, output, refused, stdout};

/// An array of 2 x 3 pixels that look at a tilted plane; the pixel in row 1 and column 2 has a longer signal path.
const SMALL: [&str; 12] = [
    "-s",
    "array.rows=2",
    "-s",
    "array.columns=3",
    "-s",
    "target.length_m=0.5",
    "-s",
    "target.width_m=0.5",
    "-s",
    "target.tilt_deg=35",
    "--seed=5",
    "--estimator=likelihood_estimator,centroid",
];

fn evaluate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["evaluate"], &SMALL[..], more].concat()
}

fn estimator<'a>(report: &'a Value, name: &str) -> &'a Value {
    let all = report["estimators"].as_array().unwrap();
    all.iter().find(|one| one["name"] == name).unwrap()
}

#[test]
fn errors_by_pixel_are_those_of_the_pixel() {
    let folder = empty();
    let offsets = "row,column,offset_ps\n0,0,0\n0,1,0\n0,2,0\n1,0,0\n1,1,0\n1,2,200\n";
    fs::write(folder.path().join("offsets.csv"), offsets).unwrap();
    let scenario = "[array]\noffset_file = \"offsets.csv\"\n[estimator]\nkind = \"likelihood\"\n";
    fs::write(folder.path().join("mine.toml"), scenario).unwrap();
    let more = ["--scenario", "mine.toml", "--repeats", "8", "--check", "2", "--json", "-o", "out"];
    let report = json(folder.path(), &evaluate(&more));
    assert_eq!((&report["rows"], &report["array"]["columns"]), (&48.into(), &3.into()));
    let found = estimator(&report, "likelihood_estimator");
    let pixels = found["by_pixel"].as_array().unwrap();
    for (k, pixel) in pixels.iter().enumerate() {
        assert_eq!((&pixel["row"], &pixel["column"]), (&(k / 3).into(), &(k % 3).into()));
        assert_eq!(pixel["estimates"], 8);
    }
    // 200 ps are 29.98 mm there and back; columns 0 and 2 see the same of the plane.
    let mean_mm = |pixel: usize| pixels[pixel]["mean_mm"].as_f64().unwrap();
    assert!((mean_mm(5) - mean_mm(3) - 29.98).abs() < 2.0, "{pixels:?}");
    assert!((mean_mm(2) - mean_mm(0)).abs() < 2.0, "{pixels:?}");
    let images = &found["images"][0];
    assert_eq!((&images["images"], &images["fill_rate"]), (&8.into(), &1.0.into()));
    let bias_mm = images["bias_by_pixel_mm"].as_f64().unwrap();
    let square = |pixel: &Value| {
        let [mean, se] = ["mean_mm", "mean_se_mm"].map(|key| pixel[key].as_f64().unwrap());
        mean * mean - se * se
    };
    let expected_mm = (pixels.iter().map(square).sum::<f64>() / 6.0).sqrt();
    assert!((bias_mm / expected_mm - 1.0).abs() < 1e-9, "{images}");
    assert_eq!(found["by_distance_m"].as_array().map(Vec::len), Some(0));
    for check in report["cross_check"].as_array().unwrap() {
        assert_eq!((&check["frames"], &check["other_depths"]), (&2.into(), &0.into()));
        assert!(check["p_value"].as_f64().unwrap() > 1e-6, "{check}");
    }
    assert_eq!(report["cross_check"][5]["pixel"], serde_json::json!([1, 2]));

    let out = folder.path().join("out");
    assert!(files(&out).contains(&"pixels.csv".to_owned()));
    let csv = fs::read_to_string(out.join("pixels.csv")).unwrap();
    assert!(csv.contains("\nlikelihood_estimator,1,2,8,0,0,"), "{csv}");
    let scenes = fs::read_to_string(out.join("scenes.csv")).unwrap();
    assert!(scenes.contains("pixel_row,pixel_column"), "{scenes}");
}

#[test]
fn columns_with_chains_of_their_own_are_drawn_and_estimated_by_these() {
    let folder = empty();
    let usual = ["-s", "tdc.profile=kintex7", "-s", "estimator.kind=likelihood"];
    // A wall, so that it is the chains that decide.
    let usual = [&SMALL[..8], &usual].concat();
    let own = [&usual[..], &["-s", "array.chains_file=../chains/columns.csv"]].concat();
    let kind = ["--estimator", "likelihood_estimator", "--json"];
    let more = ["--repeats", "40", "--check", "3", "--seed", "5"];
    let drawn = json(folder.path(), &[&["evaluate"], &own[..], &kind, &more].concat());
    for check in drawn["cross_check"].as_array().unwrap() {
        assert_eq!(check["other_depths"], 0, "{check}");
        assert!(check["p_value"].as_f64().unwrap() > 1e-6, "{check}");
    }
    let more = ["--repeats", "40", "--format", "npy", "-o", "data"];
    stdout(folder.path(), &[&["dataset"], &own[..], &more].concat());
    let data =
        |set: &[&str]| json(folder.path(), &[&["evaluate", "--data", "data"], set, &kind].concat());
    let images = |report: &Value| report["estimators"][0]["images"][0].clone();
    for images in [images(&drawn), images(&data(&own))] {
        let number = |key: &str| images[key].as_f64().unwrap();
        assert_eq!((&images["images"], number("fill_rate")), (&40.into(), 1.0));
        assert!(number("bias_by_pixel_mm") < 0.3 * number("sd_by_pixel_mm"), "{images}");
    }
    // Those of two columns fit no echo of another chain.
    let rate = images(&data(&usual))["fill_rate"].as_f64().unwrap();
    assert!((0.3..0.4).contains(&rate), "{rate}");
    for (words, said) in [
        (
            [&["evaluate", "--data", "data"], &own[..], &["-s", "array.columns=2"]].concat(),
            "columns = 3: expected 2, as array.columns has it",
        ),
        (
            [&["estimate", "data/histograms.npy"], &own[..]].concat(),
            "array.chains_file = ../chains/columns.csv: expected none",
        ),
    ] {
        let error = refused(folder.path(), &words);
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn images_have_the_statistics_of_a_sweep() {
    let folder = empty();
    let plan = "scenario = \"array\"\nset = [\"array.rows=6\", \"array.columns=8\"]\n\
        fidelity = \"histogram\"\nframes = 60\noutputs = [\"fill_rate\", \"flying_rate\", \"root_mse_mm\", \
        \"bias_by_pixel_mm\", \"sd_by_pixel_mm\"]\n\
        [[axis]]\nkey = \"firmware.shots_per_frame\"\nvalues = [4000]\n";
    fs::write(folder.path().join("p.toml"), plan).unwrap();
    let sweep = json(folder.path(), &["sweep", "p.toml", "--json"]);
    let args = ["evaluate", "--scenario", "array", "-s", "array.rows=6", "-s", "array.columns=8"];
    let more = ["-s", "firmware.shots_per_frame=4000", "--repeats", "60", "--check", "0", "--json"];
    let report = json(folder.path(), &[&args[..], &more].concat());
    let (row, images) = (&sweep["rows"][0], &report["estimators"][0]["images"][0]);
    assert_eq!(report["estimators"][0]["name"], "likelihood_estimator");
    for key in ["fill_rate", "flying_rate"] {
        let number = |of: &Value, key: &str| of[key].as_f64().unwrap();
        let se = format!("{key}_se");
        let error = number(row, &se).hypot(number(images, &se));
        let off = number(row, key) - number(images, key);
        assert!(error > 0.0 && off.abs() < 4.0 * error, "{key}: {row} and {images}");
    }
    for (key, part) in [("root_mse_mm", 0.3), ("bias_by_pixel_mm", 0.3), ("sd_by_pixel_mm", 0.3)] {
        let [swept, found] = [row, images].map(|of| of[key].as_f64().unwrap());
        assert!((found / swept - 1.0).abs() < part, "{key}: {found} for {swept}");
    }
}

#[test]
fn the_pixels_of_a_dataset_are_read_from_both_formats() {
    let folder = empty();
    let sizes = [&SMALL[..4], &SMALL[8..10], &["-s", "target.length_m=0.04"]].concat();
    let dark = ["-s", "target.width_m=0.5", "-s", "estimator.kind=likelihood"];
    let more = ["--repeats", "3", "--format", "npy,parquet", "-o", "both", "kc705"];
    stdout(folder.path(), &[&["dataset"], &sizes[..], &dark, &more].concat());
    let read = |data: &str| {
        let args = ["evaluate", "--data", data, "--estimator", "likelihood_estimator", "--json"];
        json(folder.path(), &[&args[..], &sizes[..], &dark].concat())["estimators"].clone()
    };
    let table = read("both");
    fs::remove_file(folder.path().join("both/dataset.parquet")).unwrap();
    let arrays = read("both");
    assert_eq!(table, arrays);
    let counts = table[0]["by_pixel"].as_array().unwrap().iter();
    let counts =
        counts.map(|of| of["estimates"].as_u64().unwrap() + of["failures"].as_u64().unwrap());
    // The sides see past the target, and have no distance.
    assert_eq!(counts.collect::<Vec<_>>(), [0, 3, 0, 0, 3, 0]);
    assert_eq!(table[0]["images"][0]["images"], 3);
}

#[test]
fn tables_fit_the_terminal_and_name_what_is_missing() {
    let folder = empty();
    let few = ["--repeats", "2", "--check", "0"];
    let text = stdout(folder.path(), &evaluate(&few));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for words in ["fill [%]", "bias by pixel", "No Cramer-Rao bound: the light on a pixel"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let grid = ["--grid", "target.distance_m=0.3,0.4"];
    let text = stdout(folder.path(), &evaluate(&[&grid[..], &few].concat()));
    assert!(text.contains("0.34, 0.2 W/m^2/nm, target.distance_m = 0.4"), "{text}");
    let few = ["--rows", "7", "--check", "0", "--json"];
    let report = json(folder.path(), &evaluate(&few));
    assert!(report["estimators"][0].get("images").is_none(), "{report}");
    let told = told(folder.path(), &evaluate(&["--repeats", "1", "-s", "target.distance_m=3"]));
    assert!(told.contains("the echo comes after the last bin"), "{told}");
}

fn told(folder: &Path, args: &[&str]) -> String {
    String::from_utf8(output(folder, args).stderr).unwrap()
}
