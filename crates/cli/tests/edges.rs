//! Edges of the command line: pipes that nobody writes into or reads, numbers out of range, many threads.

use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{csv, empty, files, json, output, refused, stdout, tofsim};

#[cfg(unix)]
#[test]
fn a_pipe_without_a_writer_is_refused_by_every_verb_that_reads_data() {
    let folder = empty();
    let path = folder.path();
    assert!(Command::new("mkfifo").arg(path.join("pipe")).status().unwrap().success());
    fs::write(path.join("h.csv"), csv(&vec![3; 256])).unwrap();
    let begun = Instant::now();
    let verbs = [
        &["estimate", "pipe"][..],
        &["evaluate", "--data", "pipe", "--truth", "h.csv"],
        &["evaluate", "--data", "h.csv", "--truth", "pipe"],
        &["train", "--quick", "--data", "pipe", "--truth", "h.csv"],
        &["calibrate", "pulse", "pipe", "-o", "pulse"],
        &["sweep", "merge", "pipe", "-o", "merged"],
        &["tdc", "calibrate", "pipe"],
        &["quantize", "--from", "pipe.json", "-o", "n.toml"],
        &["rerun", "pipe"],
        &["scenario", "check", "pipe"],
    ];
    std::os::unix::fs::symlink("pipe", path.join("pipe.json")).unwrap();
    let all: Vec<_> = verbs
        .iter()
        .map(|args| tofsim(path, args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn())
        .collect();
    for (child, args) in all.into_iter().zip(verbs) {
        let output = child.unwrap().wait_with_output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {error}");
        assert!(error.contains("pipe"), "{args:?}: {error}");
    }
    assert!(begun.elapsed() < Duration::from_secs(40), "{:?}", begun.elapsed());
}

#[cfg(unix)]
#[test]
fn a_histogram_is_read_from_a_pipe_as_from_a_file() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("h.csv"), csv(&vec![3; 256])).unwrap();
    assert!(Command::new("mkfifo").arg(path.join("pipe")).status().unwrap().success());
    let mut writer =
        Command::new("sh").current_dir(path).args(["-c", "exec cat h.csv > pipe"]).spawn().unwrap();
    let depth = |file: &str| json(path, &["estimate", file, "--json"])["depth_raw"].clone();
    assert_eq!(depth("pipe"), depth("h.csv"));
    assert!(writer.wait().unwrap().success());
}

#[cfg(unix)]
#[test]
fn messages_that_nobody_reads_change_nothing() {
    let folder = empty();
    let path = folder.path();
    let noted = ["run", "--waves", "none", "-v", "-s", "firmware.shots_per_frame=40", "-o", "out"];
    for (args, status) in [
        (&noted[..], 0),
        (&["run", "-s", "target.distance_m=-1"], 2),
        (&["scenario", "check", "none.toml"], 2),
        (&["run", "--frames", "x"], 2),
        (&["serve", "--port", "0", "-s", "target.distance_m=-1"], 2),
    ] {
        let mut child =
            tofsim(path, args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stderr.take());
        let mut text = String::new();
        child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(status), "{args:?}");
    }
    assert!(path.join("out/summary.json").exists());
}

#[test]
fn a_number_that_cannot_be_read_is_refused_in_words() {
    let folder = empty();
    for (args, expected) in [
        (
            &["run", "--frames", "1e6"][..],
            "'1e6' for '--frames <N>': expected a whole number in digits",
        ),
        (&["run", "--frames", "many"], "'many' for '--frames <N>': expected a whole number\n"),
        (&["run", "--seed", "-1"], "'-1' for '--seed <N>': expected a whole number from 0"),
        (&["train", "--seed", "-1"], "'-1' for '--seed <N>': expected a whole number from 0"),
        (
            &["dataset", "--rows", "0.5"],
            "'0.5' for '--rows <N>': expected a whole number in digits",
        ),
        (&["run", "--frames", "99999999999999999999"], "expected a smaller number"),
        (&["run", "--frames", "0"], "'0' for '--frames <N>': expected a whole number from 1\n"),
        (
            &["run", "--threads", "0"],
            "'0' for '--threads <N>': expected a whole number from 1 to 65535",
        ),
        (
            &["tdc", "--hits", "0"],
            "'0' for '--hits <N>': expected a whole number from 1 to 1000000000",
        ),
        (&["estimate", "a.csv", "--bin-ps", "-1"], "'-1' for '--bin-ps <PS>': expected the width"),
    ] {
        let error = refused(folder.path(), args);
        assert!(error.contains(expected), "{args:?}: {error}");
        assert!(!error.contains("invalid digit"), "{error}");
    }
}

#[test]
fn an_empty_name_is_visible_and_a_missing_file_is_named() {
    let folder = empty();
    for (args, expected) in [
        (["run", "", "--json"], "scenario: \"\": no such file or built-in scenario"),
        (["sweep", "", "--json"], "plan: \"\": no such file or built-in plan"),
        (["run", "-s", "=1"], "-s =1: expected key=value"),
        (["quantize", "--from", "no.mat"], "no.mat: cannot read: No such file"),
        (["quantize", "--from", "no"], "no: cannot read: No such file"),
        (["reproduce", "tabl-5", "--json"], "no such item (`table-6.5`?); see `reproduce --list`"),
    ] {
        let error = refused(folder.path(), &args);
        assert!(error.contains(expected), "{args:?}: {error}");
    }
}

#[test]
fn a_seed_is_the_same_number_wherever_it_is_given() {
    let folder = empty();
    let path = folder.path();
    let (most, more) = (i64::MAX.to_string(), (i64::MAX as u64 + 1).to_string());
    let hash = |seed: &[&str]| {
        let short = ["run", "--json", "--waves", "none", "-s", "firmware.shots_per_frame=40"];
        json(path, &[&short[..], seed].concat())["hash"].clone()
    };
    assert_eq!(hash(&["--seed", &most]), hash(&["-s", &format!("seed={most}")]));
    assert!(refused(path, &["run", "-s", &format!("seed={more}")]).contains("seed"));
    for verb in [
        &["run"][..],
        &["evaluate"],
        &["dataset", "-o", "d"],
        &["train"],
        &["sweep", "fig-4-2"],
        &["report", "-o", "r"],
        &["reproduce"],
        &["vectors"],
        &["tdc", "drift"],
        &["ila", "capture"],
        &["budget", "--errors"],
    ] {
        let error = refused(path, &[verb, &["--seed", &more]].concat());
        assert!(
            error.contains(&format!("expected a whole number from 0 to {most}")),
            "{verb:?}: {error}"
        );
    }
}

#[test]
fn more_threads_than_help_cost_nothing() {
    let folder = empty();
    let path = folder.path();
    let drawn = ["dataset", "--grid", "target.distance_m=0.2,0.5", "--repeats", "9", "-q"];
    for threads in ["1", "1000"] {
        let begun = Instant::now();
        stdout(path, &[&drawn[..], &["--threads", threads, "-o", threads]].concat());
        assert!(begun.elapsed() < Duration::from_secs(20), "{threads}: {:?}", begun.elapsed());
    }
    let read = |threads: &str| fs::read(path.join(threads).join("dataset.parquet")).unwrap();
    assert!(read("1") == read("1000"));
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_grow_is_an_error_and_leaves_nothing() {
    let folder = empty();
    let path = folder.path();
    let limited = format!("ulimit -f 16; exec '{}' run -o out", env!("CARGO_BIN_EXE_tofsim"));
    let output = Command::new("sh").current_dir(path).args(["-c", &limited]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("cannot write: File too large"), "{error}");
    assert!(files(&path.join("out")).is_empty() && files(&path.join("waves")).is_empty());
}

#[test]
fn what_would_take_all_memory_is_refused() {
    let folder = empty();
    let path = folder.path();
    let error = refused(path, &["train", "--quick", "--starts", "1099511627776"]);
    assert!(error.contains("candidates = 1099511627776: expected 65536 at most"), "{error}");
    let cells = ["budget", "-s", "target.shape=sphere", "-s", "target.cells=4096"];
    assert!(refused(path, &cells).contains("target.cells = 4096: expected a whole number from 8"));
    if cfg!(unix) {
        let error = refused(path, &["verify", "--rtl", "/dev/zero"]);
        assert!(error.contains("/dev/zero"), "{error}");
    }
}

#[test]
fn a_note_has_no_number_of_hundreds_of_digits() {
    let folder = empty();
    for set in ["laser.average_power_w=1e-300", "filter.sigma_nm=1e-290"] {
        let output = output(folder.path(), &["budget", "-s", set]);
        let text = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        let longest = text.iter().flat_map(|text| text.split_whitespace()).map(str::len).max();
        assert!(longest.unwrap() < 60, "{set}: {text:?}");
    }
}

#[test]
fn verbose_says_more_in_every_verb() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("h.csv"), csv(&vec![3; 256])).unwrap();
    for args in [
        &["scenario", "list"][..],
        &["scenario", "check"],
        &["budget"],
        &["estimate", "h.csv"],
        &["sweep", "list"],
    ] {
        let said = |more: &[&str]| output(path, &[args, more].concat()).stderr.len();
        assert!(said(&["-v"]) > said(&[]), "{args:?}");
    }
}

#[test]
fn every_scenario_plan_and_recipe_that_is_shown_is_read_again() {
    let folder = empty();
    let path = folder.path();
    let listed = json(path, &["scenario", "list", "--json"]);
    let named = |list: &serde_json::Value| -> Vec<String> {
        let rows = list.as_array().unwrap().iter();
        rows.map(|row| row["name"].as_str().unwrap().to_owned()).collect()
    };
    for name in named(&listed) {
        let shown = stdout(path, &["scenario", "show", &name]);
        fs::write(path.join("shown.toml"), &shown).unwrap();
        stdout(path, &["scenario", "check", "shown.toml", "-q"]);
        assert_eq!(stdout(path, &["scenario", "show", "shown.toml"]), shown, "{name}");
    }
    for name in named(&json(path, &["sweep", "list", "--json"])["plans"]) {
        fs::write(path.join("plan.toml"), stdout(path, &["sweep", "show", &name])).unwrap();
        // The last of so many shards has no points.
        let none = ["--shard", "1000000/1000000", "-o", &name, "-q"];
        stdout(path, &[&["sweep", "plan.toml"], &none[..]].concat());
    }
    for name in ["short", "brief", "quick", "uniform-16", "long", "trainlm"] {
        let shown = |recipe: &str| stdout(path, &["train", "--print-recipe", "--recipe", recipe]);
        fs::write(path.join("recipe.toml"), shown(name)).unwrap();
        assert_eq!(shown("recipe.toml"), shown(name), "{name}");
    }
}
