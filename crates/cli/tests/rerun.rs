//! An output is made again from what it records.

use std::fs;

use super::common::{json, output, refused, stdout};

/// Options of a short run.
const SHORT: [&str; 4] = ["-s", "firmware.shots_per_frame=200", "--seed", "7"];

#[test]
fn every_file_of_a_run_is_made_again_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (out, more) in [
        ("vcd", &["--events", "shots.csv", "-s", "description=a --> $end <b>"][..]),
        ("fst", &["--waves", "fst", "--events", "shots.parquet", "--threads", "1"]),
        ("ftr", &["--waves", "none", "--events", "some.csv", "--transactions", "run.ftr"]),
        ("rows", &["--waves", "none", "--events", "any.csv", "--transactions", "run.parquet"]),
        ("pair", &["--estimator", "subtraction", "--waves", "none", "--events", "pair.csv"]),
    ] {
        stdout(path, &[&["run", "-o", out], &SHORT[..], more].concat());
        let files = fs::read_dir(path.join(out)).unwrap().map(|file| file.unwrap().path());
        let mut files: Vec<_> = files.filter(|file| file.is_file()).collect();
        let named = more.windows(2).filter(|two| ["--events", "--transactions"].contains(&two[0]));
        files.extend(named.map(|two| path.join(two[1])));
        assert!(files.len() >= 4, "{files:?}");
        for file in files {
            let said = output(path, &["rerun", file.to_str().unwrap()]);
            let text = String::from_utf8_lossy(&said.stdout).into_owned();
            assert!(
                said.status.success() && text.contains("the same"),
                "{}: {text}",
                file.display()
            );
        }
    }
    let printed = stdout(path, &[&["run", "--json", "--waves", "none"], &SHORT[..]].concat());
    fs::write(path.join("printed.json"), printed).unwrap();
    assert!(stdout(path, &["rerun", "printed.json"]).contains("the same"));
}

#[test]
fn a_waveform_alone_in_another_folder_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let long = format!("description={}", "→ a description ".repeat(3000));
    fs::create_dir(path.join("mailed")).unwrap();
    for (name, more) in [
        ("kc705.fst", ["-s", "seed=3"]),
        ("kc705.vcd", ["-s", &long]),
        ("kc705.fst", ["-s", &long]),
    ] {
        let waves = name.rsplit('.').next().unwrap();
        stdout(path, &[&["run", "-o", "out", "--waves", waves], &SHORT[..], &more].concat());
        fs::rename(path.join("out").join(name), path.join("mailed").join(name)).unwrap();
        fs::remove_dir_all(path.join("out")).unwrap();
        let mailed = format!("mailed/{name}");
        assert!(stdout(path, &["rerun", &mailed]).contains("the same"), "{mailed}");
        fs::remove_file(path.join(mailed)).unwrap();
    }
}

#[test]
fn budgets_datasets_and_evaluations_are_made_again_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("budget.json"), stdout(path, &["budget", "near", "--json"])).unwrap();
    stdout(path, &["dataset", "--rows", "100", "--format", "npy,parquet", "-o", "data"]);
    stdout(path, &["evaluate", "--rows", "102", "--check", "0", "-o", "evaluated"]);
    for name in [
        "budget.json",
        "data/dataset.json",
        "data/dataset.parquet",
        "data/histograms.npy",
        "evaluated/evaluation.json",
        "evaluated/evaluation.csv",
        "evaluated/network_by_distance_m.svg",
        "evaluated/spread_by_distance_m.svg",
    ] {
        assert!(stdout(path, &["rerun", name]).contains("the same"), "{name}");
    }
    fs::remove_file(path.join("data/dataset.json")).unwrap();
    assert!(stdout(path, &["rerun", "data/dataset.parquet"]).contains("the same"));
}

#[test]
#[ignore = "long: ./check --full"]
fn a_training_is_made_again_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    stdout(path, &["train", "--quick", "--seed", "3", "--with", "limits.penalty=5", "-o", "net"]);
    for name in ["net/network.toml", "net/accuracy.csv", "net/curve.svg"] {
        assert!(stdout(path, &["rerun", name]).contains("the same"), "{name}");
    }
}

#[test]
fn vectors_captures_and_estimates_are_made_again_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let short = ["--set", "firmware.shots_per_frame=300"];
    stdout(path, &["vectors", "tdc", "--cycles", "500", "-o", "golden"]);
    let captured = [&["ila", "capture", "--probes", "fig_6_21", "--json", "-o", "ila"], &short[..]];
    fs::write(path.join("captured.json"), stdout(path, &captured.concat())).unwrap();
    stdout(path, &[&["run", "-o", "out", "--waves", "none"], &short[..]].concat());
    let histogram = ["estimate", "out/histogram.csv", "--estimator", "matched", "--json"];
    fs::write(path.join("estimated.json"), stdout(path, &histogram)).unwrap();
    let explored = ["quantize", "--explore", "uniform", "--rows", "51", "--json"];
    fs::write(path.join("explored.json"), stdout(path, &explored)).unwrap();
    for name in [
        "explored.json",
        "golden/tdc/ports.json",
        "golden/tdc/expected.mem",
        "golden/tdc/tb_tdc.v",
        "captured.json",
        "ila/fig_6_21.ila",
        "ila/fig_6_21.csv",
        "ila/fig_6_21.map.toml",
        "estimated.json",
    ] {
        assert!(stdout(path, &["rerun", name]).contains("the same"), "{name}");
    }
}

#[test]
fn what_differs_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("own.toml"), "[target]\ndistance_m = 0.3\n").unwrap();
    stdout(path, &[&["run", "own.toml", "--waves", "none", "-o", "out"], &SHORT[..]].concat());
    let name = "out/histogram.csv";
    let text = fs::read_to_string(path.join(name)).unwrap();
    fs::write(path.join(name), text.replacen("\n9,", "\n9,1", 1)).unwrap();
    let done = output(path, &["rerun", name, "--json"]);
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((done.status.code(), &report["same"]), (Some(1), &false.into()));
    assert!(report["differences"].to_string().contains("in line 12"), "{report}");
    // As long as it was, with one bin for another.
    fs::write(path.join(name), text.replacen("\n9,", "\n8,", 1)).unwrap();
    assert_eq!(output(path, &["rerun", name]).status.code(), Some(1));
    fs::write(path.join(name), &text).unwrap();
    fs::write(path.join("own.toml"), "[target]\ndistance_m = 0.31\n").unwrap();
    let done = output(path, &["rerun", name]);
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(said.contains("hash of the scenario and its files"), "{said}");
    fs::remove_file(path.join("own.toml")).unwrap();
    assert!(refused(path, &["rerun", name]).contains("cannot be made again: own.toml"));
}

#[test]
fn what_has_no_record_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), "bin,count\n").unwrap();
    assert!(refused(folder.path(), &["rerun", "a.csv"]).contains("has no record"));
    let other = "# tofsim-record {\"version\":\"\",\"scenario\":\"\",\"set\":[],\"seed\":1,\"hash\":\"\",\
        \"command\":[\"man\",\"--output=here\"]}";
    fs::write(folder.path().join("other.csv"), other).unwrap();
    let error = refused(folder.path(), &["rerun", "other.csv"]);
    assert!(
        error.contains(
            "command = man: expected a record of one of budget, estimate, quantize --explore, run"
        ),
        "{error}"
    );
    assert!(refused(folder.path(), &["rerun", "none.vcd"]).contains("none.vcd: cannot read"));
    stdout(folder.path(), &[&["run", "-o", "out"], &SHORT[..]].concat());
    let home = refused(folder.path(), &["rerun", "out/kc705.vcd", "-o", "out"]);
    assert!(home.contains("expected another folder"), "{home}");
}

#[test]
fn a_folder_holds_the_files_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let own = path.join("out/own.txt");
    stdout(path, &[&["run", "-o", "out"], &SHORT[..]].concat());
    fs::write(&own, "mine").unwrap();
    let args = [&["run", "-o", "out", "--waves", "fst"], &SHORT[..]].concat();
    let said = output(path, &args);
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("out/kc705.vcd is of an older run"), "{said}");
    assert!(!said.contains("histogram.csv is of"), "{said}");
    let summary = fs::read(path.join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let mut listed: Vec<_> =
        summary["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    listed.retain(|name| !name.contains('/'));
    listed.extend(["kc705.frame_ctrl.state.txt", "own.txt", "kc705.vcd"]);
    let mut found: Vec<_> =
        fs::read_dir(path.join("out")).unwrap().map(|file| file.unwrap().file_name()).collect();
    listed.sort();
    found.sort();
    assert_eq!(found, listed);
}

#[test]
fn a_folder_is_one_commands_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let held = tofsim::files::folder::FolderLock::take(&path.join("out")).unwrap();
    for command in [
        &["run", "--waves", "none"][..],
        &["evaluate", "--rows", "51", "--check", "0"],
        &["dataset", "--rows", "10"],
        &["train", "--quick"],
        &["vectors", "tdc", "--cycles", "100"],
        &["ila", "capture", "--probes", "fig_6_21"],
    ] {
        let error = refused(path, &[command, &["-o", "out"]].concat());
        assert!(error.contains("out: another run is writing there"), "{command:?}: {error}");
    }
    drop(held);
    assert_eq!(fs::read_dir(path).unwrap().count(), 0);
}

#[test]
fn a_run_says_what_it_was_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["run", "--json", "--waves", "none", "-s", "target.distance_m=0.3"];
    let run = json(folder.path(), &args);
    assert_eq!(run["set"], serde_json::json!(["target.distance_m=0.3"]));
    assert_eq!(
        run["command"],
        serde_json::json!(["run", "--set=target.distance_m=0.3", "--waves=none"])
    );
    let hash = |args: &[&str]| json(folder.path(), args)["hash"].as_str().unwrap().to_owned();
    assert_eq!(run["hash"].as_str().unwrap().len(), 16);
    assert_eq!(run["hash"], hash(&args));
    assert_ne!(run["hash"], hash(&["run", "--json", "--waves", "none"]));
}

#[test]
fn the_files_of_a_report_are_made_again_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    stdout(path, &["report", "near", "--quick", "-q", "--seed", "3", "-o", "page"]);
    for name in ["report.html", "waveform.json"] {
        assert!(stdout(path, &["rerun", &format!("page/{name}")]).contains("the same"), "{name}");
    }
}

#[test]
fn the_name_of_a_folder_is_no_difference_whatever_is_in_it() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a \" quote", "a ] bracket, \"", "a \\ stroke", "\u{fc}mlaut $end --> \n line"] {
        let path = folder.path().join(name);
        fs::create_dir(&path).unwrap();
        stdout(&path, &[&["run", "-o"][..], &["o\"ut/in"], &SHORT].concat());
        for file in ["summary.json", "histogram.csv"] {
            let file = format!("o\"ut/in/{file}");
            let said = stdout(&path, &["rerun", &file]);
            assert!(said.contains("the same"), "{name}: {said}");
            // From another folder, too.
            let file = path.join(file);
            let said = stdout(folder.path(), &["rerun", file.to_str().unwrap()]);
            assert!(said.contains("the same"), "{name}: {said}");
        }
    }
}
