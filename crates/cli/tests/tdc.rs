//! `tofsim tdc`: what it says of a chain, and a calibration from counts to metres.

use std::fs;

use crate::common::{empty, json, output, refused, stdout};

const KINTEX7: [&str; 2] = ["-s", "tdc.profile=kintex7"];

fn with<'a>(words: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [words, more].concat()
}

#[test]
fn a_characterisation_fits_the_terminal_and_is_made_again() {
    let folder = empty();
    let here = folder.path();
    let short = with(&["tdc", "--hits", "20000"], &KINTEX7);
    let text = stdout(here, &short);
    assert!(text.starts_with("TDC with chain kintex7, decoder ones, calibration true\n"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for words in
        ["widest bin", "equivalent bin", "INL of times, calibrated", "Bubbles at", "none is off"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    stdout(here, &with(&short, &["-o", "out"]));
    let names = ["bins.csv", "counts.csv", "transfer.csv", "tdc.json"];
    let pictures = ["widths.svg", "dnl.svg", "inl.svg", "transfer.svg", "precision.svg"];
    for name in names.iter().chain(&pictures) {
        let name = format!("out/{name}");
        assert_eq!(stdout(here, &["rerun", &name]), format!("{name}: the same\n"));
    }
    let printed = stdout(here, &with(&short, &["--json"]));
    fs::write(here.join("printed.json"), &printed).unwrap();
    assert!(stdout(here, &["rerun", "printed.json"]).contains("the same"));
    let found: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((&found["schema"], &found["hits"]), (&"tofsim.tdc/1".into(), &20_000.into()));
    let bins = fs::read_to_string(here.join("out/bins.csv")).unwrap();
    let rows = bins.lines().filter(|line| line.starts_with(char::is_numeric)).count();
    assert_eq!(rows as u64, found["taps_used"].as_u64().unwrap());
}

#[test]
fn the_file_of_decoders_has_the_numbers_of_the_object_under_their_names() {
    let folder = empty();
    let here = folder.path();
    let text = stdout(here, &with(&["tdc", "--decoders", "--hits", "2000", "-o", "out"], &KINTEX7));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let found: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(here.join("out/decoders.json")).unwrap()).unwrap();
    let csv = fs::read(here.join("out/decoders.csv")).unwrap();
    let mut csv = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(&csv[..]);
    let columns = [
        ("decoder", "/decoder"),
        ("codes", "/codes"),
        ("empty", "/empty"),
        ("lsb_ps", "/lsb_ps"),
        ("dnl_rms_lsb", "/dnl_lsb/rms"),
        ("dnl_least_lsb", "/dnl_lsb/least"),
        ("dnl_largest_lsb", "/dnl_lsb/largest"),
        ("widest_ps", "/widest_ps"),
        ("equivalent_ps", "/equivalent_ps"),
        ("raw_precision_ps", "/raw_precision_ps"),
        ("precision_ps", "/precision_ps"),
        ("raw_off", "/raw_off_by_a_bin"),
        ("off", "/off_by_a_bin"),
        ("luts", "/luts"),
        ("ffs", "/ffs"),
    ];
    assert_eq!(csv.headers().unwrap(), columns.map(|(name, _)| name).as_slice());
    let rows: Vec<_> = csv.records().map(Result::unwrap).collect();
    let objects = found["decoders"].as_array().unwrap();
    assert_eq!((rows.len(), objects.len()), (4, 4));
    for (row, object) in rows.iter().zip(objects) {
        for (field, (name, pointer)) in row.iter().zip(columns) {
            match object.pointer(pointer).unwrap() {
                serde_json::Value::String(word) => assert_eq!(field, word),
                serde_json::Value::Null => assert_eq!(field, "", "{name}"),
                number => {
                    let decimals = field.split_once('.').map_or(0, |(_, after)| after.len());
                    assert!(decimals == 0 || decimals >= 3, "{name}: {field}");
                    assert_eq!(field, format!("{:.decimals$}", number.as_f64().unwrap()), "{name}");
                }
            }
        }
    }
}

#[test]
fn counts_become_a_calibration_that_a_run_takes() {
    let folder = empty();
    let here = folder.path();
    stdout(here, &with(&["tdc", "-o", "out"], &KINTEX7));
    let calibrate = with(&["tdc", "calibrate", "out/counts.csv", "-o", "cal.csv"], &KINTEX7);
    let text = stdout(here, &calibrate);
    assert!(text.contains("1,000,000") && text.contains("standard error"), "{text}");
    assert_eq!(stdout(here, &["rerun", "cal.csv"]), "cal.csv: the same\n");
    fs::write(here.join("cal.json"), stdout(here, &with(&calibrate, &["--json"]))).unwrap();
    assert_eq!(stdout(here, &["rerun", "cal.json"]), "cal.json: the same\n");
    let precision = |more: &[&str]| {
        let args = with(&["tdc", "--json"], &KINTEX7);
        json(here, &with(&args, more))["times"]["precision_ps"].as_f64().unwrap()
    };
    let [own, by_hits, equal] = [
        precision(&[]),
        precision(&["-s", "tdc.calibration=cal.csv"]),
        precision(&["-s", "tdc.calibration=uniform"]),
    ];
    assert!(by_hits > own && by_hits < 1.15 * own && equal > 1.5 * own, "{own} {by_hits} {equal}");
    let run = ["run", "--waves", "none", "--json", "-s", "firmware.shots_per_frame=2000"];
    let histogram = |more: &[&str]| {
        let args = with(&run, &KINTEX7);
        json(here, &with(&args, more))["frames"][0]["histogram"].clone()
    };
    assert_eq!(histogram(&[]), histogram(&["-s", "tdc.calibration=true"]));
    assert_ne!(histogram(&[]), histogram(&["-s", "tdc.calibration=cal.csv"]));
    let said = output(here, &with(&run, &["-s", "tdc.calibration=uniform"]));
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("tdc.calibration = uniform: the network was not trained"), "{said}");
    // The ROM of a scenario can be looked at as it is.
    stdout(here, &with(&["vectors", "tdc_decoder", "--cycles", "200", "-o", "v"], &KINTEX7));
    assert!(here.join("v/tdc_decoder/tdc_cal.mem").is_file());
}

#[test]
fn too_few_hits_are_noted_with_the_error_that_they_leave() {
    let folder = empty();
    let here = folder.path();
    stdout(here, &with(&["tdc", "--hits", "10000", "-o", "out"], &KINTEX7));
    let calibrate = with(&["tdc", "calibrate", "out/counts.csv", "--json"], &KINTEX7);
    let found = json(here, &calibrate);
    let note = &found["notes"][0];
    assert_eq!((&note["code"], &note["value"]), (&"few-hits".into(), &10_000.0.into()));
    assert!(note["text"].as_str().unwrap().contains("standard errors up to 40.0 ps"), "{note}");
    assert!(refused(here, &with(&calibrate, &["--strict"])).contains("few-hits"));
}

#[test]
fn chains_counts_and_calibrations_that_cannot_be_used_are_refused() {
    let folder = empty();
    let here = folder.path();
    let write = |name: &str, text: &str| fs::write(here.join(name), text).unwrap();
    let counts = |text: &str| {
        write("counts.csv", text);
        refused(here, &["tdc", "calibrate", "counts.csv"])
    };
    assert!(counts("n,count\n0,0\n2,5\n").contains("counts.csv:3:1: n = 2: expected 1"));
    assert!(counts("n,count\n0,0\n1,-5\n").contains("counts.csv:3:3: count = -5"));
    assert!(counts("tap,count\n").contains("expected the header `n,count`"));
    let zero: String = (0..=800).map(|n| format!("{n},0\n")).collect();
    assert!(counts(&format!("n,count\n{zero}")).contains("expected a hit, all are 0"));
    assert!(refused(here, &["tdc", "calibrate", "no.csv"]).contains("no.csv: cannot read"));
    let chain = |text: &str| {
        write("chain.toml", text);
        refused(here, &["tdc", "-s", "tdc.profile=chain.toml"])
    };
    write("delays.csv", "tap,delay_ps\n0,nan\n");
    let text = "offset_ps = 2000\ndelays_file = \"delays.csv\"\n";
    assert!(chain(text).contains("delays.csv:2:3: delay_ps = nan"));
    let short = chain("offset_ps = 2000\n[silicon]\nslices = 150\nslice_ps = 47.3\n");
    assert!(short.contains("take 7095 ps") && short.contains("the other 905 ps"), "{short}");
    let calibration =
        |word: &str| refused(here, &["tdc", "-s", &format!("tdc.calibration={word}")]);
    assert!(calibration("false").contains("expected true, uniform or the path"));
    assert!(calibration("3").contains("tdc.calibration = 3: expected true or a text"));
    write("cal.csv", "n,age_ps,age_se_ps\n0,2000,0\n");
    assert!(calibration("cal.csv").contains("cal.csv: n = 1 rows: expected 0 to 800"));
    assert!(refused(here, &["tdc", "--hits", "0"]).contains("--hits"));
    assert!(refused(here, &["tdc", "nowhere"]).contains("no such file or built-in scenario"));
}

#[test]
fn a_rom_that_is_off_by_a_period_is_a_failed_check() {
    let folder = empty();
    let here = folder.path();
    let rows: String =
        (0..=800).map(|n| format!("{n},{},0\n", (2230 + n * 23 / 2) % 8000)).collect();
    fs::write(here.join("cal.csv"), format!("n,age_ps,age_se_ps\n{rows}")).unwrap();
    let failed = output(here, &["tdc", "--hits", "1000", "-s", "tdc.calibration=cal.csv"]);
    assert_eq!(failed.status.code(), Some(1));
    let text = String::from_utf8(failed.stdout).unwrap();
    assert!(text.contains("are off by half a period or more"), "{text}");
}

#[test]
fn a_drift_is_seen_with_one_calibration_and_not_with_the_next() {
    let folder = empty();
    let here = folder.path();
    let short = ["tdc", "drift", "--points", "3", "--over", "20", "--every", "10", "--to", "27"];
    let of = ["--repeats", "40", "--estimator", "likelihood_estimator"];
    let drift = with(&with(&short, &of), &KINTEX7);
    let text = stdout(here, &drift);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let found = json(here, &with(&drift, &["--json", "--threads", "1"]));
    assert_eq!(found["schema"], "tofsim.drift/1");
    let last = &found["points"][2];
    let mean_mm = |which: &str| last[which]["mean_mm"].as_f64().unwrap();
    assert!(mean_mm("once") > 1.0 && mean_mm("repeated").abs() < 0.2, "{last:#}");
    stdout(here, &with(&drift, &["-o", "out", "--threads", "2"]));
    for name in ["out/drift.csv", "out/drift.json", "out/drift.svg"] {
        assert_eq!(stdout(here, &["rerun", name]), format!("{name}: the same\n"));
    }
    let written: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(here.join("out/drift.json")).unwrap()).unwrap();
    assert_eq!(written["points"], found["points"]);
}

#[test]
fn temperatures_outside_the_part_s_range_are_refused() {
    let folder = empty();
    let here = folder.path();
    fs::write(here.join("log.csv"), "time_s,temperature_c,supply_mv\n0,25,0\n1,90,0\n").unwrap();
    for (args, expected) in [
        (vec!["run", "-s", "tdc.temperature_c=86"], "tdc.temperature_c = 86: expected"),
        (vec!["run", "-s", "tdc.calibrated_at_c=-1"], "tdc.calibrated_at_c = -1: expected"),
        (vec!["run", "-s", "tdc.supply_mv=nan"], "tdc.supply_mv = nan"),
        (vec!["tdc", "drift", "--to", "99"], "expected 0 to 85 degC, the part's range"),
        (vec!["tdc", "drift", "--temperatures", "log.csv"], "log.csv:3:3: temperature_c = 90"),
        (vec!["tdc", "drift", "--temperatures", "none.csv"], "none.csv"),
        (vec!["tdc", "drift", "--every", "0"], "expected more than 0"),
        (vec!["tdc", "drift", "--estimator", "subtraction"], "needs no dark histograms"),
    ] {
        let error = refused(here, &args);
        assert!(error.contains(expected), "{args:?}: {error}");
    }
}
