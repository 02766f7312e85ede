//! Datasets of an array: a row for each pixel, scene and repeat.

use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

use npyz::{Deserialize, NpyFile};
use parquet::file::reader::SerializedFileReader;
use parquet::record::Field;
use serde_json::Value;

use tofsim::optics::BinProbabilities;
use tofsim::scenario;
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::dataset::{Grid, GridPurpose, HistogramSource, Rows};

use crate::common::{empty, files, json, output, refused, stdout};

/// An array of 2 x 3 pixels that look at a tilted plane, whose sides see past it.
const SMALL: [&str; 18] = [
    "kc705",
    "-s",
    "array.rows=2",
    "-s",
    "array.columns=3",
    "-s",
    "firmware.shots_per_frame=2000",
    "-s",
    "target.length_m=0.04",
    "-s",
    "target.width_m=0.5",
    "-s",
    "target.tilt_deg=35",
    "-s",
    "laser.average_power_w=2e-6",
    "-s",
    "estimator.kind=likelihood",
    "--seed=7",
];

fn small<'a>(verb: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[verb], &SMALL[..], more].concat()
}

fn setup() -> Arc<ArraySetup> {
    let set = SMALL[1..].iter().filter(|word| word.contains('=') && !word.starts_with('-'));
    let set: Vec<_> = set.map(|&word| word.to_owned()).collect();
    Arc::new(ArraySetup::new(scenario::load("kc705", &set).unwrap()).unwrap())
}

/// The rows that the command draws.
fn rows(repeats: u64) -> Rows {
    let array = setup();
    let grid =
        Grid::own(&[], &array.common().scenario, GridPurpose::Training).unwrap().repeated(repeats);
    let grid = grid.unwrap();
    let pixels = grid.array.clone().map(|pixels| pixels.with_depths([&*array].into_iter()));
    Rows::All(Grid { array: pixels, ..grid })
}

fn array<T: Deserialize>(path: &Path) -> Vec<T> {
    NpyFile::new(&fs::read(path).unwrap()[..]).unwrap().into_vec().unwrap()
}

/// Names and values of the columns of each row of a table, but for its bins.
fn table(folder: &Path) -> Vec<Vec<(String, f64)>> {
    let file = File::open(folder.join("dataset.parquet")).unwrap();
    let row = |row: parquet::record::Row| {
        let columns = row.get_column_iter().filter(|(name, _)| name.parse::<Bin>().is_err());
        let number = |field: &Field| match *field {
            Field::UInt(number) => number.into(),
            Field::ULong(number) => number as f64,
            Field::Double(number) => number,
            ref other => panic!("{other}"),
        };
        columns.map(|(name, field)| (name.clone(), number(field))).collect()
    };
    let rows = SerializedFileReader::new(file).unwrap().into_iter();
    rows.map(|one| row(one.unwrap())).collect()
}

/// The name of a bin's column.
struct Bin;

impl std::str::FromStr for Bin {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        let number = name.strip_prefix('b').ok_or(())?;
        number.parse::<u32>().map(|_| Bin).map_err(|_| ())
    }
}

#[test]
fn every_pixel_has_its_rows_with_the_true_depth_of_the_image() {
    let folder = empty();
    let grid = ["--grid", "target.reflectance=0.2,0.4", "--grid", "laser.delay_ps=0,100"];
    let more = ["--repeats", "2", "--format", "npy,parquet", "-o", "out", "--json"];
    let report = json(folder.path(), &small("dataset", &[&grid[..], &more].concat()));
    assert_eq!((&report["grid"], &report["rows"]), (&"own".into(), &(4 * 6 * 2).into()));
    stdout(folder.path(), &small("image", &["-o", "image"]));
    let truth = array::<f64>(&folder.path().join("image/true_radial_m.npy"));
    assert!(truth.iter().any(|m| m.is_nan()) && truth.iter().any(|m| m.is_finite()), "{truth:?}");

    let out = folder.path().join("out");
    let table = table(&out);
    let names: Vec<_> = table[0].iter().map(|(name, _)| name.as_str()).collect();
    let scene = ["distance_m", "reflectance", "irradiance_w_m2_nm", "pixel_row", "pixel_column"];
    assert_eq!(names, [&["row", "seed"], &scene[..], &["laser.delay_ps"]].concat());
    let arrays = array::<f64>(&out.join("truth.npy"));
    assert_eq!(table.len(), 48);
    for (k, (row, numbers)) in table.iter().zip(arrays.chunks(6)).enumerate() {
        let values: Vec<_> = row[2..].iter().map(|(_, value)| *value).collect();
        assert!(values.iter().zip(numbers).all(|(a, b)| a.to_bits() == b.to_bits()), "{k}");
        let pixel = k / 2 % 6;
        assert_eq!(values[3..5], [(pixel / 3) as f64, (pixel % 3) as f64], "{k}");
        // The image's are of the scenario's delay and reflectance.
        assert!((values[0] - truth[pixel]).abs() < 1e-12 || truth[pixel].is_nan());
        assert_eq!(values[0].is_nan(), truth[pixel].is_nan(), "{k}");
        assert_eq!(values[1], [0.2, 0.4][k / 12 % 2]);
        assert_eq!(values[5], [0.0, 100.0][k / 24]);
    }
}

#[test]
fn the_description_has_the_array_as_the_image_has_it() {
    let folder = empty();
    stdout(folder.path(), &small("image", &["-o", "image", "-s", "array.distortion=[-0.1,0.02]"]));
    let more = ["--repeats", "1", "-o", "out", "-s", "array.distortion=[-0.1,0.02]"];
    let text = stdout(folder.path(), &small("dataset", &more));
    assert!(text.contains("2 x 3 pixels"), "{text}");
    let read = |path: &str| -> Value {
        serde_json::from_str(&fs::read_to_string(folder.path().join(path)).unwrap()).unwrap()
    };
    let (description, image) = (read("out/dataset.json"), read("image/image.json"));
    for key in ["rows", "columns", "geometry"] {
        assert_eq!(description["array"][key], image[key], "{key}");
    }
    assert!(image["geometry"]["fx"].is_number());
    let labels = description["labels"].as_array().unwrap();
    let of = |name: &str| labels.iter().find(|label| label["name"] == name).unwrap();
    assert_eq!((of("distance_m")["unit"].as_str(), of("distance_m").get("key")), (Some("m"), None));
    assert_eq!(of("pixel_column")["column"], 6);
}

#[test]
fn a_row_made_alone_is_that_of_the_whole() {
    let folder = empty();
    let more = ["--repeats", "3", "--format", "npy", "-o"];
    for threads in ["1", "2"] {
        let more = [&more[..], &[threads, "--threads", threads]].concat();
        stdout(folder.path(), &small("dataset", &more));
    }
    let counts = |threads: &str| array::<u16>(&folder.path().join(threads).join("histograms.npy"));
    let whole = counts("1");
    assert!(whole == counts("2"));
    let (source, rows) = (HistogramSource::of_arrays(&[setup()]).unwrap(), rows(3));
    for index in [0, 4, 11, 17] {
        let alone = source.block(&rows, 7, index..index + 1);
        let of_whole = &whole[256 * index as usize..][..256];
        assert!(alone[0].histogram.iter().zip(of_whole).all(|(a, b)| *a == u32::from(*b)));
    }
}

#[test]
fn histograms_have_the_distribution_of_the_images() {
    let folder = empty();
    let repeats = 300;
    let more = ["--repeats", "300", "--format", "npy", "-o", "out"];
    stdout(folder.path(), &small("dataset", &more));
    let counts = array::<u16>(&folder.path().join("out/histograms.npy"));
    let (source, rows, array) = (HistogramSource::of_arrays(&[setup()]).unwrap(), rows(1), setup());
    let sums = |histograms: &mut dyn Iterator<Item = Vec<f64>>| {
        histograms.fold(vec![0.0; 256], |sums, one| {
            sums.iter().zip(one).map(|(sum, count)| sum + count).collect()
        })
    };
    for pixel in 0..6 {
        let setup = array.pixel(pixel / 3, pixel % 3);
        let of_pixel = counts[pixel * repeats * 256..][..repeats * 256].chunks(256);
        let drawn = sums(&mut of_pixel.map(|one| one.iter().map(|&n| n.into()).collect()));
        let histograms = Histograms::new(&setup).unwrap();
        let frames = (0..repeats as u64).map(|index| histograms.frame(index).histogram);
        let frames = sums(&mut frames.map(|one| one.iter().map(|&n| n.into()).collect()));
        // Of each bin the difference of two Poisson numbers.
        let pairs: Vec<_> = drawn.iter().zip(&frames).filter(|(a, b)| *a + *b > 10.0).collect();
        let chi2: f64 = pairs.iter().map(|(a, b)| (*a - *b).powi(2) / (*a + *b)).sum();
        let (cells, spread) = (pairs.len() as f64, (2.0 * pairs.len() as f64).sqrt());
        // Only the columns in the middle see the target.
        assert_eq!(cells > 3.0, pixel % 3 == 1, "{pixel}: {cells} bins");
        assert!((chi2 - cells).abs() <= 4.5 * spread, "{pixel}: {chi2} of {cells}");

        let (_, scene) = rows.row(pixel as u64);
        let hazard = tofsim::optics::Hazard::new(&setup.budget);
        let expected = BinProbabilities::new(&hazard, &setup.bins());
        let found = source.probabilities(&scene);
        for (found, expected) in found.of_code().iter().zip(expected.of_code()) {
            assert!((found - expected).abs() < 1e-12, "{pixel}: {found} for {expected}");
        }
    }
}

#[test]
fn notes_count_the_pixels_that_have_them() {
    let folder = empty();
    let told = |verb, more: &[&str]| {
        let output = output(folder.path(), &small(verb, more));
        let text = String::from_utf8(output.stderr).unwrap();
        text.lines().find(|line| line.contains("pixels")).unwrap_or_default().to_owned()
    };
    let of_image = told("image", &[]);
    assert!(of_image.contains("of 6 pixels"), "{of_image}");
    assert_eq!(told("dataset", &["-o", "out", "--repeats", "1"]), of_image);
}

#[test]
fn what_an_array_does_not_have_is_refused_and_leaves_nothing() {
    let folder = empty();
    let refused = |verb, more: &[&str]| {
        let error = refused(folder.path(), &small(verb, more));
        let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(files(folder.path()).is_empty(), "{more:?}");
        error
    };
    let error = refused("dataset", &["-o", "out", "--grid", "test"]);
    assert!(error.contains("--grid: test: expected KEY=... or no grid"), "{error}");
    let error = refused("dataset", &["-o", "out", "-s", "array.rows=-1"]);
    assert!(error.contains("array.rows = -1: expected a whole number from 1 to 64"), "{error}");
    let many = ["-o", "out", "-s", "array.rows=64", "-s", "array.columns=64"];
    let axis = ["--grid", "target.distance_m=0.1..0.5:0.01"];
    let error = refused("dataset", &[&many[..], &axis].concat());
    assert!(error.contains("167936 pixels in 41 settings"), "{error}");
    let error = refused("dataset", &["-o", "out", "-s", "firmware.mode=1"]);
    assert!(error.contains("firmware.mode = 1: expected 0 for a dataset"), "{error}");
}

#[test]
fn the_size_of_the_array_is_no_axis() {
    let folder = empty();
    for axis in ["array.rows=2,3", "array.columns=4"] {
        let error = refused(folder.path(), &["dataset", "array", "-o", "out", "--grid", axis]);
        let found = axis.replace('=', " = ");
        assert!(error.contains(&format!("--grid: {found}: expected no axis")), "{error}");
    }
}

#[test]
fn training_over_a_grid_takes_single_pixels_only() {
    let folder = empty();
    let args = ["train", "array", "-o", "out"];
    let error = refused(folder.path(), &args);
    assert!(error.contains("array.rows = 40") && error.contains("single pixels"), "{error}");
}
