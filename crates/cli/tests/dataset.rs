//! Datasets as a user makes and reads them.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use parquet::data_type::{DataType, DoubleType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

use tofsim_learn::dataset::{self, Grid, HistogramSource, Rows, Sample, Subset};

use crate::common::{empty, files, json, npy, refused, setup, stdout};

/// The arguments of a dataset of a few hundred rows, as both formats.
const FEW: [&str; 9] =
    ["dataset", "near", "--rows", "300", "--seed", "9", "--format", "parquet,npy", "-o"];

#[test]
fn both_formats_hold_the_rows_that_the_library_draws() {
    let folder = empty();
    let out = stdout(folder.path(), &[&FEW[..], &["out"]].concat());
    assert!(out.contains("random scenes of train"), "{out}");
    let out = folder.path().join("out");
    let names = ["dataset.json", "dataset.parquet", "histograms.npy", "rows.npy", "truth.npy"];
    assert_eq!(files(&out), names);

    let table = dataset::read(&out.join("dataset.parquet")).unwrap();
    fs::remove_file(out.join("dataset.parquet")).unwrap();
    let arrays = dataset::read(&out).unwrap();
    assert!(table == arrays);

    let source = HistogramSource::new(&setup("near", &[])).unwrap();
    let rows = Rows::Subset(Subset::new(Grid::training(), 300, 9));
    assert_eq!(table.len(), 300);
    for (index, sample) in table.iter().enumerate() {
        let row = rows.row(index as u64);
        let histogram = source.draw(&row.scene, 9, row.number);
        assert_eq!(*sample, Sample { seed: 9, row: row.number, scene: row.scene, histogram });
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
    let samples = dataset::read(&path).unwrap();
    assert_eq!(samples[0].scene.distance_m, 0.1);
    assert_eq!(samples[59].scene.distance_m, 0.6);
    let most = samples.iter().map(|s| s.histogram.iter().map(|&n| u32::from(n)).sum::<u32>()).max();
    assert!((400..=500).contains(&most.unwrap()), "{most:?}");
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
    let read = |name| dataset::read(&folder.path().join(name)).unwrap();
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
    assert!(error.contains("firmware.mode = 1: a dataset draws"), "{error}");
    assert!(refused(&["tdc_validation"]).contains("stimulus"));
    assert!(refused(&["--profile", "unifrom"]).contains("uniform, table6_3, ideal"));
    assert!(refused(&["--rows", "0"]).contains("--rows"));
    assert!(refused(&["--grid", "tset"]).contains("possible values: train, test"));
    assert!(refused(&["--format", "parquet,csv"]).contains("possible values: parquet, npy"));
}

/// What is said about the dataset in `folder`, after the file's name.
fn fault(folder: &Path, file: &str) -> String {
    let message = dataset::read(folder).unwrap_err().to_string();
    let name = if file.is_empty() { folder.to_owned() } else { folder.join(file) };
    let name = name.display().to_string();
    message.strip_prefix(&name).unwrap_or_else(|| panic!("{message}")).to_owned()
}

#[test]
fn arrays_that_do_not_fit_are_refused_by_name() {
    let folder = empty();
    stdout(folder.path(), &[&FEW[..], &["."]].concat());
    fs::remove_file(folder.path().join("dataset.parquet")).unwrap();
    let with = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        let good = fs::read(&path).unwrap();
        fs::write(&path, bytes).unwrap();
        let error = fault(folder.path(), name);
        fs::write(&path, good).unwrap();
        error
    };
    let truth = [0.5f64; 3].map(f64::to_le_bytes).concat();
    let check = |found: String, expected: &str| assert_eq!(found, expected);
    check(with("truth.npy", &npy("<f4", "(300, 3)", &truth)), ": dtype = <f4: expected <f8");
    check(
        with("truth.npy", &npy("<f8", "(300, 4)", &truth)),
        ": shape = (300, 4): expected (n, 3)",
    );
    check(
        with("truth.npy", &npy("<f8", "(1, 3)", &truth)),
        ": row 1: ends here, histograms.npy goes on: expected as many rows in both",
    );
    check(
        with("truth.npy", &npy("<f8", "(300, 3)", &truth)),
        ": the file ends 299 rows before its array",
    );
    let nan = [0.5, f64::NAN, 0.5].map(f64::to_le_bytes).concat();
    check(
        with("truth.npy", &npy("<f8", "(300, 3)", &nan)),
        ": row 0, column reflectance = NaN: expected a number from 0",
    );
    check(
        with("truth.npy", b"distance"),
        ": expected the header of an .npy file with a plain array: the file ends within it",
    );
    check(
        with("rows.npy", &npy("<u8", "(301, 2)", &[0; 301 * 16])),
        ": row 300: goes on for 1 rows, histograms.npy does not: expected as many rows in both",
    );
    let bins = with("histograms.npy", &npy("<u2", "(1, 255)", &[0; 510]));
    check(bins, ": shape = (1, 255): expected (256) or (n, 256), n at least 1");
    fs::remove_file(folder.path().join("rows.npy")).unwrap();
    assert!(fault(folder.path(), "rows.npy").starts_with(": cannot read"));
}

#[test]
fn what_is_no_dataset_is_refused() {
    let folder = empty();
    assert!(fault(folder.path(), "").contains("expected dataset.parquet, or histograms.npy"));
    let path = folder.path().join("x");
    assert!(dataset::read(&path).unwrap_err().to_string().contains("cannot read"));
    fs::write(&path, "bin,count\n").unwrap();
    assert!(dataset::read(&path).unwrap_err().to_string().contains("expected a Parquet file"));
    fs::write(&path, "PAR1 and no more").unwrap();
    assert!(dataset::read(&path).unwrap_err().to_string().contains("unreadable Parquet"));
}

/// A column of a table: its name, its type as Parquet has it, and its values.
type Column = (String, &'static str, Vec<Option<f64>>);

/// Writes a table of three rows with all that a dataset has, after a change, as data frames write it:
/// any value may be missing, whole numbers have 64 bits.
fn table(path: &Path, change: impl FnOnce(&mut Vec<Column>)) {
    let names = ["row", "seed", "distance_m", "reflectance", "irradiance_w_m2_nm"];
    let bins = (0..256).map(|bin| format!("b{bin}"));
    let column = |name: String| {
        let kind = if name.contains("_m") || name == "reflectance" { "double" } else { "int64" };
        (name, kind, vec![Some(0.0), Some(1.0), Some(2.0)])
    };
    let mut columns: Vec<_> =
        names.map(str::to_owned).into_iter().chain(bins).map(column).collect();
    change(&mut columns);
    let fields = columns.iter().map(|(name, kind, _)| format!("optional {kind} {name}; "));
    let schema = parse_message_type(&format!("message m {{ {} }}", fields.collect::<String>()));
    let file = fs::File::create(path).unwrap();
    let properties = Arc::new(WriterProperties::default());
    let mut file = SerializedFileWriter::new(file, Arc::new(schema.unwrap()), properties).unwrap();
    let mut group = file.next_row_group().unwrap();
    for (_, kind, values) in &columns {
        match *kind {
            "double" => put::<DoubleType>(&mut group, values, |value| value),
            "int32" => put::<Int32Type>(&mut group, values, |value| value as i32),
            _ => put::<Int64Type>(&mut group, values, |value| value as i64),
        }
    }
    group.close().unwrap();
    file.close().unwrap();
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, fs::File>,
    values: &[Option<f64>],
    of: fn(f64) -> T::T,
) {
    let there: Vec<_> = values.iter().flatten().map(|&value| of(value)).collect();
    let defined: Vec<_> = values.iter().map(|value| value.is_some() as i16).collect();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<T>().write_batch(&there, Some(&defined), None).unwrap();
    column.close().unwrap();
}

#[test]
fn a_table_of_a_data_frame_is_read() {
    let folder = empty();
    let path = folder.path().join("mine.parquet");
    table(&path, |columns| {
        columns.insert(0, ("note".to_owned(), "int32", vec![None; 3]));
        columns.reverse();
    });
    let samples = dataset::read(&path).unwrap();
    assert_eq!(samples.len(), 3);
    assert_eq!((samples[2].row, samples[2].seed, samples[2].scene.distance_m), (2, 2, 2.0));
    assert_eq!(samples[1].histogram, [1; 256]);
}

#[test]
fn a_table_that_does_not_fit_is_refused_by_column() {
    let folder = empty();
    let check = |change: fn(&mut Vec<Column>), expected: &str| {
        let path = folder.path().join("t.parquet");
        table(&path, change);
        assert_eq!(fault(&path, ""), expected);
    };
    check(|all| drop(all.pop()), ": bins = 255: expected 256 columns, b0 to b255");
    check(
        |all| all.push(("b256".to_owned(), "int64", vec![Some(0.0); 3])),
        ": bins = 257: expected 256 columns, b0 to b255",
    );
    check(|all| all[9].0 = "b999".to_owned(), ": column b4: missing, expected INT32 or INT64");
    check(|all| drop(all.remove(2)), ": column distance_m: missing, expected DOUBLE");
    check(|all| all[3].1 = "int32", ": type of column reflectance = INT32: expected DOUBLE");
    check(|all| all[7].1 = "double", ": type of column b2 = DOUBLE: expected INT32 or INT64");
    check(|all| all[7].2[1] = None, ": row 1, column b2 = null: expected a number");
    check(
        |all| all[7].2[2] = Some(65_536.0),
        ": row 2, column b2 = 65536: expected a whole number from 0 to 65535",
    );
    check(
        |all| all[2].2[0] = Some(-0.5),
        ": row 0, column distance_m = -0.5: expected a number from 0",
    );
    check(
        |all| (5..7).for_each(|bin| all[bin].2[0] = Some(40_000.0)),
        ": row 0, total = 80000: the estimator's bit widths allow 65535 hits in all",
    );
}

#[test]
fn a_damaged_table_is_an_error_and_no_panic() {
    let panics = Arc::new(AtomicUsize::new(0));
    let (counted, here) = (Arc::clone(&panics), std::thread::current().id());
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if std::thread::current().id() == here {
            counted.fetch_add(1, Ordering::Relaxed);
        }
        before(panic);
    }));
    let folder = empty();
    let path = folder.path().join("t.parquet");
    table(&path, |_| ());
    let good = fs::read(&path).unwrap();
    for place in (4..good.len()).step_by(good.len() / 400) {
        let mut bytes = good.clone();
        bytes[place] ^= 0x55;
        fs::write(&path, &bytes).unwrap();
        if let Err(error) = dataset::read(&path) {
            assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
        }
        fs::write(&path, &good[..place]).unwrap();
        assert!(dataset::read(&path).is_err());
    }
    assert_eq!(panics.load(Ordering::Relaxed), 0);
}
