//! Depth images on the command line: files that other programs read, single pixels, and what is refused.

mod second_target;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use crate::common::{empty, json, output, refused, stdout};

/// A small array of short frames.
const SMALL: [&str; 8] = [
    "array",
    "-s",
    "array.rows=6",
    "-s",
    "array.columns=8",
    "-s",
    "firmware.shots_per_frame=2000",
    "--seed=3",
];

fn image<'a>(options: &[&'a str]) -> Vec<&'a str> {
    [&["image"], &SMALL[..], options].concat()
}

/// Returns shape and numbers of an array.
fn array<T: npyz::Deserialize>(path: &Path) -> (Vec<u64>, Vec<T>) {
    let file = npyz::NpyFile::new(BufReader::new(File::open(path).unwrap())).unwrap();
    (file.shape().to_vec(), file.into_vec().unwrap())
}

/// Returns the rows of a file with a value for each pixel, by column.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

#[test]
fn arrays_pictures_and_clouds_say_the_same() {
    let folder = empty();
    let out = folder.path().join("out");
    let text = stdout(folder.path(), &image(&["-o", "out"]));
    assert!(text.contains("6 x 8 pixels") && text.contains("signal hits"), "{text}");

    let numbers = |name: &str| {
        let (shape, numbers) = array::<f64>(&out.join(name));
        assert_eq!(shape, [6, 8], "{name}");
        numbers
    };
    let [radial, perpendicular, sigma, truth] =
        ["depth_radial_m.npy", "depth_perpendicular_m.npy", "sigma_m.npy", "true_radial_m.npy"]
            .map(numbers);
    let [signal, ambient] = ["signal.npy", "ambient.npy"].map(numbers);
    let (_, valid) = array::<bool>(&out.join("valid.npy"));
    let (_, status) = array::<u16>(&out.join("status.npy"));
    let (_, hits) = array::<u64>(&out.join("hits.npy"));
    let is_valid: Vec<_> = status.iter().map(|&status| status == 0).collect();
    assert_eq!(valid, is_valid);
    assert!((24..48).contains(&valid.iter().filter(|&&valid| valid).count()), "{valid:?}");
    for place in 0..48 {
        assert_eq!(valid[place], radial[place].is_finite() && sigma[place] > 0.0);
        assert!(!valid[place] || perpendicular[place] < radial[place]);
        let (expected, hits) = (signal[place] + ambient[place], hits[place] as f64);
        assert!((hits - expected).abs() < 6.0 * expected.sqrt(), "{place}: {hits} of {expected}");
    }
    // The wall is behind the table, and the upper half of the image is wall but for what hangs there.
    assert!(truth[0] > 0.85 && truth[47] < 0.7, "{truth:?}");

    let rows = rows(&out.join("pixels.csv"));
    let in_rows: Vec<f64> =
        rows.iter().map(|row| row["depth_radial_m"].parse().unwrap_or(f64::NAN)).collect();
    assert!(in_rows.iter().zip(&radial).all(|(a, b)| a.to_bits() == b.to_bits()));

    let decoder =
        png::Decoder::new(BufReader::new(File::open(out.join("depth_radial.png")).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut grey = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut grey).unwrap();
    assert_eq!((info.width, info.height, info.bit_depth), (8, 6, png::BitDepth::Sixteen));
    let millimetres = grey.chunks(2).map(|word| f64::from(u16::from_be_bytes([word[0], word[1]])));
    for (millimetres, radial) in millimetres.zip(&radial) {
        assert_eq!(millimetres, if radial.is_nan() { 0.0 } else { (1e3 * radial).round() });
    }

    let pcd = fs::read_to_string(out.join("cloud.pcd")).unwrap();
    assert!(pcd.contains("\nWIDTH 8\nHEIGHT 6\n") && pcd.contains("\nPOINTS 48\n"));
    let (_, points) = pcd.split_once("DATA ascii\n").unwrap();
    let points: Vec<Vec<f64>> = points
        .lines()
        .map(|line| line.split(' ').map(|number| number.parse().unwrap()).collect())
        .collect();
    for (place, point) in points.iter().enumerate() {
        let &[x, y, z, of_sigma, _, of_status] = &point[..] else { panic!("{point:?}") };
        assert_eq!(of_status, f64::from(status[place]));
        if valid[place] {
            assert!((x.hypot(y).hypot(z) / radial[place] - 1.0).abs() < 1e-6);
            assert!((z / perpendicular[place] - 1.0).abs() < 1e-6);
            assert!((of_sigma / sigma[place] - 1.0).abs() < 1e-6);
            assert_eq!((x > 0.0, y > 0.0), (place % 8 >= 4, place / 8 >= 3), "{place}");
        } else {
            assert!(x.is_nan() && z.is_nan());
        }
    }
    let ply = fs::read_to_string(out.join("cloud.ply")).unwrap();
    let (header, vertices) = ply.split_once("end_header\n").unwrap();
    let count = valid.iter().filter(|&&valid| valid).count();
    assert!(header.contains(&format!("\nelement vertex {count}\n")), "{header}");
    let finite = pcd.lines().skip_while(|line| !line.starts_with("DATA")).skip(1);
    let finite: Vec<_> = finite.filter(|line| !line.starts_with("nan")).collect();
    assert_eq!(vertices.lines().collect::<Vec<_>>(), finite);
}

#[test]
fn several_images_are_a_first_axis_and_every_file_is_the_same_for_any_number_of_threads() {
    let folder = empty();
    for threads in ["1", "3"] {
        let options = ["--images", "2", "--threads", threads, "-q", "-o", threads];
        stdout(folder.path(), &image(&options));
    }
    let [one, three] = ["1", "3"].map(|name| folder.path().join(name));
    let mut count = 0;
    for file in fs::read_dir(&one).unwrap() {
        let file = file.unwrap();
        let other = three.join(file.file_name());
        assert_eq!(fs::read(file.path()).unwrap(), fs::read(&other).unwrap(), "{other:?}");
        count += 1;
    }
    assert_eq!(count, 16);
    let (shape, _) = array::<u64>(&one.join("hits.npy"));
    let (expected, _) = array::<f64>(&one.join("signal.npy"));
    assert_eq!((&shape[..], &expected[..]), (&[2, 6, 8][..], &[6, 8][..]));
    let found = json(folder.path(), &image(&["--images", "2", "--json"]));
    assert_eq!(found["images"].as_array().unwrap().len(), 2);
    assert_ne!(found["images"][0], found["images"][1]);
    for name in
        ["image.json", "image.svg", "pixels.csv", "depth_radial.png", "cloud.pcd", "cloud.ply"]
    {
        let path = one.join(name);
        let again = stdout(folder.path(), &["rerun", path.to_str().unwrap()]);
        assert!(again.contains("the same"), "{name}: {again}");
    }
}

#[test]
fn a_pixel_alone_is_that_of_the_image_at_every_fidelity() {
    let folder = empty();
    let path = folder.path();
    // Each pixel simulates its whole row there.
    let crosstalk =
        ["-s", "spad.crosstalk_probability=0.3", "-s", "array.rows=5", "-s", "array.columns=6"];
    let crosstalk = &crosstalk[..];
    for (fidelity, set) in [
        ("shot", &[][..]),
        ("cycle", &[]),
        ("histogram", &[]),
        ("shot", crosstalk),
        ("cycle", crosstalk),
    ] {
        let of = |more: &[&str], name: &str| {
            let words = ["--images", "2", "--fidelity", fidelity, "-q", "-o", name];
            stdout(path, &image(&[&words, set, more].concat()));
            rows(&path.join(name).join("pixels.csv"))
        };
        let whole = of(&[], "whole");
        let alone = of(&["--pixel", "4,5"], "alone");
        let here = |row: &&BTreeMap<String, String>| row["row"] == "4" && row["column"] == "5";
        assert_eq!(
            alone,
            whole.into_iter().filter(|row| here(&row)).collect::<Vec<_>>(),
            "{fidelity}"
        );
        assert_eq!(alone.len(), 2);
        if fidelity == "histogram" {
            continue;
        }
        let words = ["run", "--json", "--waves", "none", "--frames", "2", "--fidelity", fidelity];
        let run = json(path, &[&words, &SMALL[..], set, &["--pixel", "4,5"]].concat());
        for (row, frame) in alone.iter().zip(run["frames"].as_array().unwrap()) {
            assert_eq!(row["hits"].parse::<u64>().unwrap(), frame["hits"], "{fidelity}");
            let depth = row["depth_radial_m"].parse::<f64>().ok();
            let is_valid = frame["valid"] == true;
            assert_eq!(depth, frame["depth_m"].as_f64().filter(|_| is_valid), "{fidelity}");
        }
        let truth: f64 = alone[0]["true_radial_m"].parse().unwrap();
        assert!((run["frames"][0]["true_depth_m"].as_f64().unwrap() - truth).abs() < 1e-8, "{run}");
    }
}

#[test]
fn faults_of_an_array_are_named() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("few.csv"), "row,column,offset_ps\n0,0,1\n").unwrap();
    fs::write(
        path.join("few.toml"),
        "[array]\nrows = 2\ncolumns = 2\noffset_file = \"few.csv\"\n[laser]\ndelay_ps = 50\n",
    )
    .unwrap();
    fs::write(path.join("few-chains.csv"), "column,profile\n0,ideal\n1,uniform\n").unwrap();
    let chains = "[array]\nrows = 2\ncolumns = 3\nchains_file = \"few-chains.csv\"\n";
    fs::write(path.join("chains.toml"), chains).unwrap();
    let refusals: [(&[&str], &str); 13] = [
        (&["image", "-s", "array.rows=0"], "array.rows = 0: expected a whole number from 1 to 64"),
        (
            &["image", "-s", "array.columns=65"],
            "array.columns = 65: expected a whole number from 1 to 64",
        ),
        (&["image", "-s", "array.field_of_view_deg=[180, 20]"], "array.field_of_view_deg"),
        (&["image", "-s", "array.field_of_view_deg=20"], "array.field_of_view_deg"),
        (
            &["image", "-s", "spad.field_of_view_deg=20"],
            "array.field_of_view_deg, or the illuminated cone",
        ),
        (&["image", "-s", "array.distortion=[-40, 0]"], "array.distortion"),
        (&["image", "-s", "target.mesh_file=none.obj"], "none.obj"),
        (&["image", "few.toml"], "missing = row 0, column 1: expected a line for each of 2 x 2"),
        (&["image", "chains.toml"], "missing = column 2: expected a line for each of 3 columns"),
        (
            &["image", "-s", "array.columns=1", "-s", "array.chains_file=../chains/columns.csv"],
            "array.chains_file = ../chains/columns.csv: expected none, or several columns",
        ),
        (&["image", "--pixel", "40,0"], "--pixel: 40,0: expected rows 0 to 39 and columns 0 to 29"),
        (&["image", "--pixel", "3"], "expected a row and a column from 0"),
        (&["run", "array"], "array.rows = 40: expected 1 here: `tofsim image`"),
    ];
    for (words, expected) in refusals {
        let error = refused(path, words);
        assert!(error.contains(expected), "{words:?}: {error}");
    }
    let pixel = refused(path, &["run", "--pixel", "0,1"]);
    assert!(pixel.contains("expected rows 0 to 0"), "{pixel}");
}

#[test]
fn pixels_without_an_echo_are_counted() {
    let folder = empty();
    // It fills less than half of the field of view.
    let plate = "[array]\nrows = 6\ncolumns = 8\n[target]\nlength_m = 0.02\nwidth_m = 0.02\n";
    fs::write(folder.path().join("plate.toml"), plate).unwrap();
    let words = ["image", "plate.toml", "--json", "--fidelity", "histogram"];
    let found = json(folder.path(), &words);
    let text = |note: &serde_json::Value| note["text"].as_str().unwrap().to_owned();
    let notes: Vec<_> = found["notes"].as_array().unwrap().iter().map(text).collect();
    let counted =
        notes.iter().any(|note| note.contains("of 48 pixels") && note.contains("hardly any"));
    assert!(counted, "{notes:?}");
    let strict = output(folder.path(), &[&words[..], &["--strict"]].concat());
    assert_eq!(strict.status.code(), Some(2));
}

#[test]
fn an_image_states_the_image_rate_of_the_firmware() {
    let folder = empty();
    let few = image(&["--fidelity", "histogram", "-s", "estimator.kind=centroid", "--json"]);
    let json = json(folder.path(), &few);
    // 256 bins, 2000 shots of 6 cycles, 1 and 16 cycles of Drain; eight estimates of 312 + 2 cycles meanwhile.
    let firmware = &json["firmware"];
    assert_eq!(firmware["row_cycles"], 256 + 2000 * 6 + 1 + 16);
    assert_eq!(firmware["image_cycles"], 6 * 12_273);
    assert_eq!(firmware["depth_latency_cycles"], 16 + 8 * 314 - 1);
    assert_eq!(firmware["images_per_s"], 1.0 / (6.0 * 12_273.0 * 8e-9));
    let rows = ["image", "array", "-s", "array.rows=41", "-s", "array.columns=1", "--json"];
    let json = self::json(folder.path(), &[&rows[..], &["--fidelity", "histogram"]].concat());
    assert!(json["firmware"].is_null(), "{json}");
}

#[test]
fn an_array_that_no_firmware_scans_is_refused_by_what_needs_one() {
    let vectors = ["vectors", "tof_top", "-o", "out", "--scenario", "array"];
    for (set, said) in [
        (&["-s", "array.rows=41"][..], "array.rows = 41: expected at most 40 for the firmware"),
        (&["-s", "tdc.recalibrate_frames=3"], "expected 0 with an array"),
        (&["-s", "array.banks=3"], "array.banks = 3: expected a whole number from 1 to 2"),
        (&["-s", "array.rows=1", "--language", "vhdl"], "benches in VHDL have one detector"),
        (&["-s", "pll.jitter_rms_ps=5"], "pll.jitter_rms_ps"),
    ] {
        let folder = empty();
        let few = &["-s", "firmware.shots_per_frame=20"][..];
        let error = refused(folder.path(), &[&vectors[..], few, set].concat());
        assert!(error.contains(said) && !folder.path().join("out").exists(), "{set:?}: {error}");
    }
}
