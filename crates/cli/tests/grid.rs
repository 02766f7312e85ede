//! `--grid`: scenes of one's own.

use std::fs;
use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};
use serde_json::Value;

use crate::common::{empty, files, json, refused, setup, stdout};

/// Elements of an array of numbers.
fn array<T: npyz::Deserialize>(path: &Path) -> Vec<T> {
    npyz::NpyFile::new(&fs::read(path).unwrap()[..]).unwrap().into_vec().unwrap()
}

fn values(report: &Value) -> Vec<f64> {
    report.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn a_dataset_of_one_s_own_has_those_scenes_and_says_so() {
    let folder = empty();
    let grid =
        ["--grid", "target.distance_m=0.7..0.9:0.1", "--grid", "target.reflectance=0.05,0.9"];
    let more = ["-s", "ambient.irradiance_w_m2_nm=0.1", "--repeats", "3", "--format", "npy"];
    let report =
        json(folder.path(), &[&["dataset", "--json", "-o", "out"], &grid[..], &more].concat());
    assert_eq!((&report["rows"], &report["grid"]), (&18.into(), &"own".into()));
    assert_eq!(report["axes"][0]["key"], "target.distance_m");
    assert_eq!(report["axes"][0]["values"], "0.7..0.9:0.1");
    assert_eq!(report["set"][0], "ambient.irradiance_w_m2_nm=0.1");
    let truth = array::<f64>(&folder.path().join("out/truth.npy"));
    let rows: Vec<_> = truth.chunks_exact(3).collect();
    assert_eq!(rows[0], [0.7, 0.05, 0.1]);
    assert_eq!(rows[2], rows[0]);
    assert_eq!(rows[3], [0.7, 0.9, 0.1]);
    assert_eq!(rows[17], [0.9, 0.9, 0.1]);

    // The same from a file.
    let text = "[target]\ndistance_m = \"0.7..0.9:0.1\"\nreflectance = [0.05, 0.9]\n";
    fs::write(folder.path().join("mine.toml"), text).unwrap();
    stdout(folder.path(), &[&["dataset", "--grid", "mine.toml", "-o", "file"], &more[..]].concat());
    let read = |of: &str| fs::read(folder.path().join(of).join("histograms.npy")).unwrap();
    assert!(read("file") == read("out"));
}

#[test]
fn any_other_key_may_be_on_a_grid_and_is_a_column() {
    let folder = empty();
    let grid =
        ["--grid", "laser.pulse_sigma_ps=100,200", "--grid", "firmware.shots_per_frame=99,7"];
    let refusal = refused(folder.path(), &[&["dataset", "-o", "out"], &grid[..]].concat());
    assert!(refusal.contains("rising values"), "{refusal}");
    let grid =
        ["--grid", "laser.pulse_sigma_ps=100,200", "--grid", "firmware.shots_per_frame=7,99"];
    let args = ["dataset", "--json", "--repeats", "1", "--format", "npy,parquet", "-o", "out"];
    let report = json(folder.path(), &[&args, &grid[..]].concat());
    assert_eq!(report["shots_per_frame"], Value::Null);
    let truth = array::<f64>(&folder.path().join("out/truth.npy"));
    let rows: Vec<_> = truth.chunks_exact(5).map(|row| [row[3], row[4]]).collect();
    assert_eq!(rows, [[100.0, 7.0], [100.0, 99.0], [200.0, 7.0], [200.0, 99.0]]);
    let counts = array::<u16>(&folder.path().join("out/histograms.npy"));
    let most = |row: usize| counts[256 * row..][..256].iter().map(|&n| u32::from(n)).sum::<u32>();
    assert!(most(0) <= 7 && most(2) <= 7 && most(1) > 50 && most(3) > 50);
    let file = fs::File::open(folder.path().join("out/dataset.parquet")).unwrap();
    let table = SerializedFileReader::new(file).unwrap();
    let schema = table.metadata().file_metadata().schema_descr();
    let names: Vec<_> = (3..8).map(|k| schema.column(k).name().to_owned()).collect();
    let own = ["laser.pulse_sigma_ps", "firmware.shots_per_frame", "b0"];
    assert_eq!(names, [&["reflectance", "irradiance_w_m2_nm"], &own[..]].concat());
    // A wider pulse spreads the same frame's photons.
    let wide = setup("kc705", &["laser.pulse_sigma_ps=200"]);
    assert_eq!(wide.budget.pulse.sigma_ps(), 200.0);
}

#[test]
fn an_evaluation_follows_the_grid() {
    let folder = empty();
    let args = [
        "evaluate",
        "--check",
        "1",
        "--estimator",
        "likelihood,likelihood_estimator,matched",
        "--json",
    ];
    let grid = [
        "--grid",
        "target.distance_m=0.1..0.9:0.1",
        "--grid",
        "laser.pulse_sigma_ps=100,200",
        "--grid",
        "ambient.irradiance_w_m2_nm=0,0.2",
    ];
    let report = json(folder.path(), &[&args[..], &grid, &["-o", "out"]].concat());
    let distances = values(&report["distances_m"]);
    assert_eq!(distances, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
    let bound = values(&report["cramer_rao_two_sd_mm"]);
    assert_eq!(bound.len(), 9);
    assert!(bound[8] > 2.0 * bound[1], "{bound:?}");
    assert!(report.get("thesis").is_none());
    assert_eq!(report["grid"]["axes"][3]["values"], "100,200");
    for one in &report["estimators"].as_array().unwrap()[..2] {
        assert_eq!(one["worst_ratio_to_thesis"], Value::Null);
        assert_eq!(one["by_distance_m"].as_array().unwrap().len(), 9);
        // Each setting's likelihood knows its own pulse, or it would be off by many millimetres.
        let groups = one["by_key"][0]["groups"].as_array().unwrap();
        assert_eq!(one["by_key"][0]["key"], "laser.pulse_sigma_ps");
        for group in groups {
            assert!(group["mean_mm"].as_f64().unwrap().abs() < 0.5, "{group}");
            assert!(group["two_sd_mm"].as_f64().unwrap() < 3.0, "{group}");
        }
    }
    let at: Vec<_> = report["cross_check"].as_array().unwrap().iter().collect();
    let at: Vec<_> = at.iter().map(|check| check["distance_m"].as_f64().unwrap()).collect();
    assert_eq!(at, [0.1, 0.3, 0.5, 0.7, 0.9]);
    let csv = fs::read_to_string(folder.path().join("out/evaluation.csv")).unwrap();
    assert!(csv.contains("\nmatched,laser.pulse_sigma_ps,200,"), "{csv}");
    let picture = folder.path().join("out/likelihood_by_distance_m.svg");
    assert!(!fs::read_to_string(picture).unwrap().contains("thesis"));
    // A picture of each estimator and one of all, for four quantities, and that of the spread.
    assert_eq!(files(&folder.path().join("out")).len(), 3 + 4 * 4 + 1);

    let text = stdout(folder.path(), &[&args[..5], &grid[..2]].concat());
    assert!(!text.contains("thesis") && text.contains("Cramer-Rao") && text.contains("0.9 m"));
}

#[test]
fn what_the_grid_overrides_is_refused_by_name() {
    let folder = empty();
    for verb in
        [&["dataset", "-o", "out"][..], &["evaluate"], &["quantize", "--explore", "uniform"]]
    {
        let error = refused(folder.path(), &[verb, &["-s", "target.distance_m=0.9"]].concat());
        assert!(error.contains("-s target.distance_m=0.9: the grid has"), "{error}");
    }
    let grid = ["dataset", "-o", "out", "--grid", "spad.pdp=0.01,0.02", "-s", "spad.pdp=0.03"];
    assert!(refused(folder.path(), &grid).contains("-s spad.pdp=0.03: the grid has"));
    assert!(files(folder.path()).is_empty());
}

#[test]
fn what_is_no_grid_is_refused() {
    let folder = empty();
    for (grid, expected) in [
        (
            "target.distance_m=500..1001:501",
            "target.distance_m = 1001: expected a number from 0.001 to 1000.0",
        ),
        ("target.distance_m=0.1..0.5", "expected FROM..TO:STEP"),
        ("target.distance_m=0.1..0.5:1e-9", "no more than 1000000 values"),
        ("target.distanse_m=0.1", "did you mean `distance_m`?"),
        ("firmware.mode=0,1", "firmware.mode = 1: expected 0 for a dataset: in MODE 1"),
        ("firmware.laser_en=0", "expected true or false"),
        ("none.toml", "none.toml"),
    ] {
        let error = refused(folder.path(), &["dataset", "-o", "out", "--grid", grid]);
        assert!(error.contains(expected), "{grid}: {error}");
    }
    let many = ["--grid", "target.distance_m=0.1..0.6:0.0001", "--repeats", "99999999"];
    let error = refused(folder.path(), &[&["evaluate"], &many[..]].concat());
    assert!(error.contains("histograms, expected 100000000 at most"), "{error}");
    assert!(refused(folder.path(), &["evaluate", "--rows", "999999999"]).contains("--rows"));
}
