//! `evaluate --data`: histograms of one's own, with their true distances.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use parquet::data_type::{DoubleType, FloatType};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::Value;

use crate::common::{empty, files, json, output, refused, stdout};

const DRAWN: [&str; 9] = [
    "dataset",
    "--grid",
    "target.distance_m=0.2,0.3,0.5",
    "--grid",
    "target.reflectance=0.1,0.5",
    "--repeats",
    "20",
    "--format",
    "npy,parquet",
];
const ESTIMATORS: [&str; 2] = ["--estimator", "network,likelihood"];

fn evaluate(folder: &Path, more: &[&str]) -> Value {
    json(folder, &[&["evaluate", "--json"], &ESTIMATORS[..], more].concat())
}

/// Writes floats as an array of one dimension.
fn floats(path: &Path, values: &[f64]) {
    let shape = format!("({},)", values.len());
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    fs::write(path, bytes).unwrap();
}

/// Writes a table of 256 float bins, all `count`, and distances.
fn table(path: &Path, count: f32, distances_m: &[f64]) {
    let bins: String = (0..256).map(|bin| format!("required float b{bin}; ")).collect();
    let schema = format!("message measured {{ required double distance_m; {bins} }}");
    let schema = Arc::new(parse_message_type(&schema).unwrap());
    let properties = Arc::new(WriterProperties::builder().build());
    let file = fs::File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, properties).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<DoubleType>().write_batch(distances_m, None, None).unwrap();
    column.close().unwrap();
    while let Some(mut column) = group.next_column().unwrap() {
        let mut counts = vec![1.0; distances_m.len()];
        *counts.last_mut().unwrap() = count;
        column.typed::<FloatType>().write_batch(&counts, None, None).unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
}

#[test]
fn a_folder_a_table_and_arrays_with_their_truth_are_evaluated_alike() {
    let folder = empty();
    let folder = folder.path();
    stdout(folder, &[&DRAWN[..], &["-o", "d"]].concat());
    let whole = evaluate(folder, &["--data", "d", "-o", "out"]);
    assert_eq!((&whole["schema"], &whole["rows"]), (&"tofsim.evaluate/1".into(), &120.into()));
    assert_eq!(whole["notes"].as_array().unwrap().len(), 0);
    let by_distance = whole["estimators"][1]["by_distance_m"].as_array().unwrap();
    assert_eq!(by_distance.len(), 3);
    for group in by_distance {
        assert!(group["mean_mm"].as_f64().unwrap().abs() < 0.5, "{group}");
        assert!(group["two_sd_mm"].as_f64().unwrap() < 3.0, "{group}");
    }
    assert!(files(&folder.join("out")).contains(&"evaluation.csv".to_owned()));

    let table = evaluate(folder, &["--data", "d/dataset.parquet"]);
    assert_eq!(table["estimators"], whole["estimators"]);
    let histograms = ["--data", "d/histograms.npy", "--truth"];
    let arrays = evaluate(folder, &[&histograms[..], &["d/truth.npy"]].concat());
    assert_eq!(arrays["estimators"], whole["estimators"]);
    // Distances alone: nothing is known of the light.
    let distances: Vec<f64> = [0.2, 0.3, 0.5].into_iter().flat_map(|m| [m; 40]).collect();
    floats(&folder.join("t.npy"), &distances);
    let alone = evaluate(folder, &[&histograms[..], &["t.npy"]].concat());
    assert_eq!(alone["estimators"][0]["by_distance_m"], whole["estimators"][0]["by_distance_m"]);
    assert_eq!(alone["estimators"][0]["by_reflectance"].as_array().unwrap().len(), 0);
    let text = stdout(folder, &["evaluate", "--data", "d"]);
    assert!(text.contains("0.5 m") && !text.contains("thesis"), "{text}");
}

#[test]
fn a_chain_or_a_number_of_shots_that_is_not_the_scenario_s_is_refused() {
    let folder = empty();
    let folder = folder.path();
    let other = ["-o", "d", "--profile", "ideal", "-s", "firmware.shots_per_frame=500"];
    stdout(folder, &[&DRAWN[..], &other].concat());
    let data = ["evaluate", "ideal", "--data", "d"];
    let error = refused(folder, &data);
    assert!(
        error.contains("d: profile = ideal: expected uniform, as the scenario has it"),
        "{error}"
    );
    let error = refused(folder, &[&data[..], &["--profile", "ideal"]].concat());
    assert!(error.contains("shots_per_frame = 500: expected 30000"), "{error}");
    let right = ["--profile", "ideal", "-s", "firmware.shots_per_frame=500"];
    let told = output(folder, &[&data[..], &right].concat());
    assert!(told.status.success());
    let told = String::from_utf8(told.stderr).unwrap();
    assert!(told.contains("firmware.shots_per_frame = 500: the network was not trained"), "{told}");
    let strict = [&data[..], &right, &["--strict"]].concat();
    assert!(refused(folder, &strict).contains("--strict"));
}

#[test]
fn what_is_no_count_is_refused_with_row_and_column() {
    let folder = empty();
    let path = folder.path().join("m.parquet");
    table(&path, 3.0, &[0.2, 0.4]);
    assert_eq!(evaluate(folder.path(), &["--data", "m.parquet"])["rows"], 2);
    for (count, shown) in [(0.5, "0.5"), (-1.0, "-1"), (70_000.0, "70000"), (f32::NAN, "NaN")] {
        table(&path, count, &[0.2, 0.4]);
        for verb in [&["evaluate", "--data"][..], &["estimate"]] {
            let error = refused(folder.path(), &[verb, &["m.parquet"]].concat());
            let expected = format!("row 1, column b0 = {shown}: expected a whole number from 0");
            assert!(error.contains(&expected), "{error}");
        }
    }
    table(&path, 3.0, &[0.2, -0.4]);
    let error = refused(folder.path(), &["evaluate", "--data", "m.parquet"]);
    assert!(error.contains("row 1, column distance_m = -0.4"), "{error}");
    table(&path, 300.0, &[0.2, 0.4]);
    assert!(refused(folder.path(), &["estimate", "m.parquet"]).contains("total of row 1 = 76800"));
    let bytes = fs::read(&path).unwrap();
    for length in [8, bytes.len() / 2, bytes.len() - 9] {
        fs::write(&path, &bytes[..length]).unwrap();
        let error = refused(folder.path(), &["estimate", "m.parquet"]);
        assert!(error.contains("unreadable Parquet"), "{error}");
    }
}

#[test]
fn a_truth_that_does_not_fit_is_refused() {
    let folder = empty();
    let folder = folder.path();
    stdout(folder, &[&DRAWN[..], &["-o", "d"]].concat());
    floats(&folder.join("t.npy"), &[0.2, 0.3]);
    let arrays = ["evaluate", "--data", "d/histograms.npy"];
    let error = refused(folder, &[&arrays[..], &["--truth", "t.npy"]].concat());
    assert!(error.contains("t.npy: 2 rows, expected 120"), "{error}");
    assert!(refused(folder, &arrays).contains("--truth FILE.npy"));
    assert!(refused(folder, &["evaluate", "--data", "none"]).contains("none"));
    assert!(refused(folder, &["evaluate", "--data", "."]).contains("expected dataset.parquet, or"));
    let both = ["evaluate", "--data", "d", "--grid", "thesis"];
    assert!(refused(folder, &both).contains("cannot be used with"));
    let pair = ["evaluate", "--data", "d", "--estimator", "subtraction"];
    assert!(refused(folder, &pair).contains("it also needs a dark one"));
}

#[test]
fn a_network_is_trained_on_histograms_of_one_s_own() {
    let folder = empty();
    let folder = folder.path();
    stdout(folder, &[&DRAWN[..], &["-o", "d"]].concat());
    let train = ["train", "--quick", "--with", "limits.penalty=50", "--data", "d", "-o", "n"];
    let report = json(folder, &[&train[..], &["--json"]].concat());
    assert_eq!(values(&report["distances_m"]), [0.2, 0.3, 0.5]);
    let network = tofsim::network::Network::load(&folder.join("n/network.toml")).unwrap();
    assert!(network.training.command.unwrap().contains("--data d"));
    let domain = network.domain.unwrap();
    assert_eq!(domain.ranges["target.distance_m"], [0.2, 0.5]);
    assert_eq!(domain.ranges["target.reflectance"], [0.1, 0.5]);
    let found = evaluate(folder, &["n/network.toml", "--data", "d"]);
    assert_eq!(found["notes"].as_array().unwrap().len(), 0);
    let two_sd = found["estimators"][0]["all"]["two_sd_mm"].as_f64().unwrap();
    assert!(two_sd < 60.0, "{two_sd}");
    let again = [&train[..], &["--resume", "--seed", "2"]].concat();
    assert!(refused(folder, &again).contains("of another training"));
    let few = ["dataset", "--grid", "target.distance_m=0.2,0.3", "--repeats", "3", "-o", "few"];
    stdout(folder, &few);
    let error = refused(folder, &["train", "--quick", "--data", "few"]);
    assert!(error.contains("histograms at 0.2 m, expected 10 or more"), "{error}");
}

fn values(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn numbers_after_the_array_are_refused_in_every_npy_file() {
    let folder = empty();
    let path = folder.path();
    stdout(path, &[&DRAWN[..], &["-o", "d"]].concat());
    let appended = |name: &str| {
        let mut bytes = fs::read(path.join(name)).unwrap();
        bytes.push(7);
        fs::write(path.join("more.npy"), bytes).unwrap();
    };
    let expected = "more.npy: unreadable .npy: the file goes on after the numbers that its header";
    appended("d/histograms.npy");
    assert!(refused(path, &["estimate", "more.npy"]).contains(expected));
    let evaluated = ["evaluate", "--data", "more.npy", "--truth", "d/truth.npy"];
    assert!(refused(path, &evaluated).contains(expected));
    appended("d/truth.npy");
    let evaluated = ["evaluate", "--data", "d/histograms.npy", "--truth", "more.npy"];
    assert!(refused(path, &evaluated).contains(expected));
    fs::create_dir(path.join("arrays")).unwrap();
    for (name, numbers) in [("b1", vec![0.5; 8]), ("b2", vec![0.1])] {
        floats(&path.join(format!("arrays/{name}.npy")), &numbers);
    }
    appended("arrays/b2.npy");
    fs::rename(path.join("more.npy"), path.join("arrays/b2.npy")).unwrap();
    let error = refused(path, &["quantize", "--from", "arrays", "-o", "n.toml"]);
    assert!(error.contains("arrays/b2.npy: unreadable .npy: the file goes on"), "{error}");
}
