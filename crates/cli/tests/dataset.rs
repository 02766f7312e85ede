//! Datasets as a user makes and reads them.

use std::fs;
use std::path::Path;

use npyz::{Deserialize, NpyFile};
use parquet::file::reader::SerializedFileReader;
use parquet::record::Field;

use tofsim::network::histogram_file;
use tofsim_learn::dataset::{Grid, HistogramSource, Rows, Sample, Scene, Subset};

use crate::common::{empty, files, json, refused, setup, stdout};

/// The arguments of a dataset of a few hundred rows, as both formats.
const FEW: [&str; 9] =
    ["dataset", "near", "--rows", "300", "--seed", "9", "--format", "parquet,npy", "-o"];

/// The rows of a dataset's table.
fn table(folder: &Path) -> Vec<Sample> {
    let file = fs::File::open(folder.join("dataset.parquet")).unwrap();
    let rows = SerializedFileReader::new(file).unwrap().into_iter();
    let sample = |row: parquet::record::Row| {
        let (mut whole, mut real) = (Vec::new(), Vec::new());
        for (_, field) in row.get_column_iter() {
            match *field {
                Field::UShort(count) => whole.push(count.into()),
                Field::ULong(number) => whole.push(number),
                Field::Double(number) => real.push(number),
                ref other => panic!("{other}"),
            }
        }
        let histogram = (0..256).map(|bin| whole[2 + bin] as u32).collect();
        Sample { seed: whole[1], row: whole[0], scene: scene(&real), histogram }
    };
    rows.map(|row| sample(row.unwrap())).collect()
}

/// The same from its arrays.
fn arrays(folder: &Path) -> Vec<Sample> {
    fn values<T: Deserialize>(path: &Path) -> Vec<T> {
        NpyFile::new(&fs::read(path).unwrap()[..]).unwrap().into_vec().unwrap()
    }
    let truth = values::<f64>(&folder.join("truth.npy"));
    let rows = values::<u64>(&folder.join("rows.npy"));
    let histograms =
        histogram_file::open(&folder.join("histograms.npy"), Default::default()).unwrap();
    let truth = truth.chunks_exact(3).zip(rows.chunks_exact(2));
    let sample = |(histogram, (truth, row)): (tofsim::Result<_>, (&[f64], &[u64]))| Sample {
        seed: row[1],
        row: row[0],
        scene: scene(truth),
        histogram: histogram.unwrap(),
    };
    histograms.zip(truth).map(sample).collect()
}

fn scene(truth: &[f64]) -> Scene {
    let &[distance_m, reflectance, irradiance_w_m2_nm] = truth else { panic!("{truth:?}") };
    Scene { distance_m, reflectance, irradiance_w_m2_nm, ..Scene::default() }
}

#[test]
fn both_formats_hold_the_rows_that_the_library_draws() {
    let folder = empty();
    let out = stdout(folder.path(), &[&FEW[..], &["out"]].concat());
    assert!(out.contains("random scenes of train"), "{out}");
    let out = folder.path().join("out");
    let names = ["dataset.json", "dataset.parquet", "histograms.npy", "rows.npy", "truth.npy"];
    assert_eq!(files(&out), names);

    let table = table(&out);
    assert!(table == arrays(&out));

    let source = HistogramSource::new(&setup("near", &[])).unwrap();
    let rows = Rows::Subset(Subset::new(Grid::training(), 300, 9));
    assert_eq!(table.len(), 300);
    for (index, sample) in table.iter().enumerate() {
        let (row, scene) = rows.row(index as u64);
        let histogram = source.draw_from(&source.probabilities(&scene), &scene, 9, row);
        assert_eq!(*sample, Sample { seed: 9, row, scene, histogram });
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = empty();
    for threads in ["1", "2"] {
        stdout(folder.path(), &[&FEW[..], &[threads, "--threads", threads]].concat());
    }
    let names = files(&folder.path().join("1"));
    assert_eq!(names.len(), 5);
    for name in names {
        let bytes = |threads| fs::read(folder.path().join(threads).join(&name)).unwrap();
        assert!(bytes("1") == bytes("2"), "{name}");
    }
}

#[test]
fn the_description_says_where_the_rows_come_from() {
    let folder = empty();
    let args = ["dataset", "-s", "firmware.shots_per_frame=500", "--profile", "ideal", "--json"];
    let more = ["--grid", "test", "--rows", "60", "-o", "out"];
    let report = json(folder.path(), &[&args[..], &more].concat());
    let path = folder.path().join("out");
    let description: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path.join("dataset.json")).unwrap()).unwrap();
    for report in [&report, &description] {
        assert_eq!(report["schema"], "tofsim.dataset/1");
        assert_eq!(report["scenario"], "kc705");
        assert_eq!(report["set"][0], "firmware.shots_per_frame=500");
        assert_eq!(report["profile"], "ideal");
        assert_eq!(report["settings"]["tdc"]["profile"], "ideal");
        assert_eq!((&report["grid"], &report["subset"]), (&"test".into(), &true.into()));
        assert_eq!((&report["rows"], &report["seed"]), (&60.into(), &1.into()));
        assert_eq!(report["shots_per_frame"], 500);
    }
    assert_eq!(report["files"].as_array().unwrap().len(), 2);
    let samples = table(&path);
    assert_eq!(samples[0].scene.distance_m, 0.1);
    assert_eq!(samples[59].scene.distance_m, 0.6);
    let most = samples.iter().map(|s| s.histogram.iter().sum::<u32>()).max();
    assert!((400..=500).contains(&most.unwrap()), "{most:?}");
}

#[test]
fn each_label_is_found_by_its_entry_in_the_description() {
    let folder = empty();
    let grid = ["--grid", "laser.pulse_sigma_ps=100,200", "--grid", "target.distance_m=0.2,0.3"];
    let args = ["dataset", "--format", "npy,parquet", "-o", "out"];
    stdout(folder.path(), &[&args[..], &grid].concat());
    let out = folder.path().join("out");
    let text = fs::read_to_string(out.join("dataset.json")).unwrap();
    let description: serde_json::Value = serde_json::from_str(&text).unwrap();
    let labels = description["labels"].as_array().unwrap();
    let found: Vec<_> = labels
        .iter()
        .map(|label| ["name", "unit", "file"].map(|key| label[key].as_str().unwrap()))
        .collect();
    let expected = |file| {
        let names = [
            ("distance_m", "m"),
            ("reflectance", "1"),
            ("irradiance_w_m2_nm", "W/m^2/nm"),
            ("laser.pulse_sigma_ps", "ps"),
        ];
        names.map(|(name, unit)| [name, unit, file])
    };
    assert_eq!(found, [expected("truth.npy"), expected("dataset.parquet")].concat());

    let bytes = fs::read(out.join("truth.npy")).unwrap();
    let array = NpyFile::new(&bytes[..]).unwrap();
    let shape = array.shape().to_vec();
    let truth: Vec<f64> = array.into_vec().unwrap();
    let table = SerializedFileReader::new(fs::File::open(out.join("dataset.parquet")).unwrap());
    let rows: Vec<_> = table.unwrap().into_iter().map(Result::unwrap).collect();
    let [in_array, in_table] = [&labels[..4], &labels[4..]];
    let whole = |value: &serde_json::Value| value.as_u64().unwrap() as usize;
    for (a, b) in in_array.iter().zip(in_table) {
        assert_eq!(a["shape"], serde_json::json!(shape));
        assert_eq!(b["shape"], serde_json::json!([rows.len(), rows[0].len()]));
        for (row, values) in rows.iter().zip(truth.chunks(shape[1] as usize)) {
            let (name, field) = row.get_column_iter().nth(whole(&b["column"])).unwrap();
            assert_eq!(b["name"], **name);
            assert_eq!(*field, Field::Double(values[whole(&a["column"])]), "{name}");
        }
    }
}

#[test]
fn a_chain_file_is_seen_from_where_the_program_runs() {
    let folder = empty();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::write(folder.path().join("scenes/s.toml"), "").unwrap();
    fs::write(folder.path().join("c.toml"), "offset_ps = 2000\ntap_ps = 12.5\n").unwrap();
    let args = ["dataset", "scenes/s.toml", "--rows", "20", "-o"];
    stdout(folder.path(), &[&args[..], &["own", "--profile", "c.toml"]].concat());
    stdout(folder.path(), &[&args[..], &["ideal", "--profile", "ideal"]].concat());
    let read = |name| table(&folder.path().join(name));
    assert!(read("own") == read("ideal"));
}

#[test]
fn what_cannot_be_drawn_is_refused_and_leaves_nothing() {
    let folder = empty();
    let refused = |args: &[&str]| {
        let error = refused(folder.path(), &[&["dataset", "-o", "out"], args].concat());
        assert!(files(folder.path()).is_empty(), "{args:?}");
        error
    };
    let error = refused(&["-s", "firmware.mode=1"]);
    assert!(error.contains("firmware.mode = 1: expected 0 for a dataset: in MODE 1"), "{error}");
    assert!(refused(&["tdc_validation"]).contains("stimulus"));
    assert!(refused(&["--profile", "unifrom"]).contains("uniform, table6_3, ideal"));
    assert!(refused(&["--rows", "0"]).contains("--rows"));
    assert!(refused(&["--grid", "tset"]).contains("expected thesis, train, test, KEY="));
    assert!(refused(&["--format", "parquet,csv"]).contains("possible values: parquet, npy"));
}
