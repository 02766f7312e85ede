//! `tofsim quantize --from`: networks trained elsewhere, against what MATLAB's arithmetic gives.

use std::fs;
use std::path::Path;

use tofsim::network::{Histogram, Network};
use tofsim_learn::quantize::import;

use crate::common::{self, json, refused};

const MAT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/network_arrays.mat");
const JSON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/network_arrays.json");

/// Histograms and their depths, by `tests/reference/network_arrays.py` [m].
fn reference() -> Vec<(Histogram, f64)> {
    let text = fs::read_to_string("tests/reference/network_arrays_depths.json").unwrap();
    let tree: serde_json::Value = serde_json::from_str(&text).unwrap();
    let rows = tree["histograms"].as_array().unwrap().iter();
    rows.zip(tree["depths_m"].as_array().unwrap())
        .map(|(row, depth)| {
            let count = |bin: usize| row[bin].as_u64().unwrap() as u32;
            ((0..256).map(count).collect(), depth.as_f64().unwrap())
        })
        .collect()
}

#[test]
fn a_matlab_file_and_json_fold_to_what_matlab_computes() {
    let (mat, json) = (import::read(Path::new(MAT), 256), import::read(Path::new(JSON), 256));
    let (mat, json) = (mat.unwrap(), json.unwrap());
    for (histogram, depth_m) in reference() {
        assert!((mat.forward(&histogram) - depth_m).abs() < 1e-12);
        assert!((json.forward(&histogram) - depth_m).abs() < 1e-12);
    }
}

#[test]
fn a_folder_of_numpy_arrays_is_the_same_network() {
    let folder = tempfile::tempdir().unwrap();
    let float = import::read(Path::new(JSON), 256).unwrap();
    let put = |name: &str, shape: &str, values: &[f64]| {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        fs::write(folder.path().join(name), common::npy("<f8", shape, &bytes)).unwrap();
    };
    put("IW.npy", "(8, 256)", &float.w1.concat());
    put("LW.npy", "(1, 8)", &float.w2);
    put("b1.npy", "(8,)", &float.b1);
    put("b2.npy", "(1,)", &[float.b2]);
    assert_eq!(import::read(folder.path(), 256).unwrap(), float);
    put("b1.npy", "(7,)", &float.b1[..7]);
    let error = import::read(folder.path(), 256).unwrap_err().to_string();
    assert!(error.contains("IW: 8 x 256, expected 7 x 256"), "{error}");
}

#[test]
fn the_program_writes_a_network_that_runs_and_its_roms() {
    let folder = tempfile::tempdir().unwrap();
    let (file, roms) = (folder.path().join("net.toml"), folder.path().join("roms"));
    let arguments = ["quantize", "--from", MAT, "--chain", "ideal", "--saturate", "--json", "-o"];
    let (file, roms) = (file.to_str().unwrap(), roms.to_str().unwrap());
    let report = json(folder.path(), &[&arguments[..], &[file, "--roms", roms]].concat());
    assert_eq!(report["schema"], "tofsim.quantize/1");
    assert_eq!(report["files"].as_array().unwrap().len(), 6);
    let network = Network::load(Path::new(file)).unwrap();
    assert_eq!(network.training.chain, "ideal");
    let float = import::read(Path::new(MAT), 256).unwrap();
    assert_eq!(network.float.get().as_deref(), Some(&float));
    let rom = fs::read_to_string(Path::new(roms).join("w1.mem")).unwrap();
    let word = format!("{:04x}", network.fixed.w1[0][9] as u16);
    assert!(rom.lines().nth(9).unwrap().ends_with(&word));
    let set = format!("estimator.network={file}");
    json(
        folder.path(),
        &["run", "--waves", "none", "--fidelity", "histogram", "--json", "-s", &set],
    );
}

#[test]
fn what_is_wrong_is_named_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("net.toml");
    let out = out.to_str().unwrap();
    let write = |name: &str, text: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let tree = fs::read_to_string(JSON).unwrap();
    for (from, expected) in [
        (write("a.json", b"{\"IW\": [1], \"b\": [[1, 2], 3]}"), "IW: 1, expected 2 x 256"),
        (write("f.json", b"{\"IW\": [1]}"), "b1: missing"),
        (write("b.json", tree.replace("\"LW\"", "\"LV\"").as_bytes()), "LW: missing"),
        (write("c.mat", b"no such format"), "not a MATLAB file of level 5"),
        (write("d.txt", b""), "expected a .mat or .json file"),
        (write("e.json", tree.replacen("\"gain\": 4.0", "\"gain\": 0.001", 1).as_bytes()), "w2[0]"),
        ("nowhere.json".to_owned(), "cannot read"),
    ] {
        let error = refused(folder.path(), &["quantize", "--from", &from, "-o", out]);
        assert!(error.contains(expected), "{error}");
        assert!(!Path::new(out).exists(), "{from}");
    }
    for (option, value, expected) in [
        ("--lut-bits", "99", "--lut-bits: 99: expected 4 to 16"),
        ("--format", "w1=99.23", "99"),
        ("--format", "b1=16.30", "--format: b1.fraction = 30: expected"),
    ] {
        let error = refused(folder.path(), &["quantize", "--from", JSON, option, value]);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn an_exploration_has_the_network_s_datapath_and_its_neighbours() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["quantize", "--explore", "uniform", "--rows", "510"];
    let report = json(folder.path(), &[&arguments[..], &["--json"]].concat());
    assert_eq!(report["schema"], "tofsim.exploration/1");
    let points = report["points"].as_array().unwrap();
    let point = |variant: &str| points.iter().find(|point| point["variant"] == variant).unwrap();
    let own = point("the network's own");
    assert_eq!((&own["ramb36"], &own["dsp48"]), (&10.into(), &10.into()));
    assert_eq!(own["saturated_weights"], 0);
    let rms = |point: &serde_json::Value| point["rms_to_float_mm"].as_f64().unwrap();
    let coarse = point("table of 9 address bits over +-4");
    assert!(rms(coarse) > 4.0 * rms(own) && rms(own) < 0.5);
    assert!(coarse["ramb36"].as_u64() < own["ramb36"].as_u64());
    let text = common::stdout(folder.path(), &arguments);
    assert!(text.contains("table of 14 address bits over +-8"), "{text}");

    let error = refused(folder.path(), &["quantize"]);
    assert!(error.contains("--from") && error.contains("--explore"), "{error}");
    refused(folder.path(), &["quantize", "--from", JSON, "--explore", "uniform"]);
    let error = refused(folder.path(), &["quantize", "--explore", "nosuch"]);
    assert!(error.contains("nosuch"), "{error}");
}

/// A MATLAB file of level 5 with arrays of small whole numbers, of a class and stored as a type.
fn whole_numbers(class: u32, kind: u32, bytes: usize) -> Vec<u8> {
    let element = |kind: u32, data: &[u8]| {
        let length = data.len() as u32;
        let mut element = [&kind.to_le_bytes(), &length.to_le_bytes(), data].concat();
        element.resize(element.len().next_multiple_of(8), 0);
        element
    };
    let array = |name: &str, shape: [i32; 2]| {
        let numbers = (0..shape[0] * shape[1]).map(|k| i64::from(k * 7 % 11 - 5));
        let numbers: Vec<u8> = match kind {
            9 => numbers.flat_map(|number| (number as f64).to_le_bytes()).collect(),
            _ => numbers.flat_map(|number| number.to_le_bytes().into_iter().take(bytes)).collect(),
        };
        let flags = element(6, &[class.to_le_bytes(), [0; 4]].concat());
        let shape = element(5, &shape.map(i32::to_le_bytes).concat());
        let parts = [flags, shape, element(1, name.as_bytes()), element(kind, &numbers)].concat();
        element(14, &parts)
    };
    let mut file = b"MATLAB 5.0 MAT-file, written by a test".to_vec();
    file.resize(124, b' ');
    file.extend([0, 1, b'I', b'M']);
    let arrays = [("IW", [8, 256]), ("LW", [1, 8]), ("b1", [8, 1]), ("b2", [1, 1])];
    arrays.iter().for_each(|&(name, shape)| file.extend(array(name, shape)));
    file
}

#[test]
fn whole_numbers_of_a_matlab_file_are_read_whatever_they_are_stored_as() {
    let folder = tempfile::tempdir().unwrap();
    let read = |file: &[u8]| {
        let path = folder.path().join("net.mat");
        fs::write(&path, file).unwrap();
        import::read(&path, 256).unwrap()
    };
    let expected = read(&whole_numbers(6, 9, 8));
    assert_eq!(expected.b1, [-5.0, 2.0, -2.0, 5.0, 1.0, -3.0, 4.0, 0.0]);
    // Doubles and singles as int8, int16 and int32, as Octave stores them; then arrays of these types.
    for (class, kind, bytes) in
        [(6, 1, 1), (7, 1, 1), (6, 3, 2), (6, 5, 4), (8, 1, 1), (10, 3, 2), (12, 5, 4), (14, 12, 8)]
    {
        assert_eq!(read(&whole_numbers(class, kind, bytes)), expected, "class {class}, {kind}");
    }
}
