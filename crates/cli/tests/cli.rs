//! The command line as users and scripts meet it.

use std::fs;

use crate::common::{empty, files, json, short_run as run, stdout};

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_does_not() {
    let folder = empty();
    let of = |args: &[&str]| {
        stdout(folder.path(), &[&["run", "--json", "--waves", "none"], args].concat())
    };
    assert_eq!(of(&[]), of(&[]));
    assert_ne!(of(&[]), of(&["--seed", "2"]));
    let frames = |args: &[&str]| of(args).split_once("\"frames\":").unwrap().1.to_owned();
    assert_eq!(frames(&["--seed", "7"]), frames(&["-s", "seed=7"]));
    assert_eq!(files(folder.path()), [""; 0], "nothing is written");
}

#[test]
fn waveforms_and_events_are_reproducible_to_the_byte() {
    let (one, two) = (empty(), empty());
    let names =
        |format: &str| [format!("kc705.{format}"), "shots.parquet".into(), "histogram.svg".into()];
    for format in ["vcd", "fst"] {
        for folder in [&one, &two] {
            let args = ["-o", ".", "--events", "shots.parquet", "--waves", format];
            stdout(folder.path(), &run(&args));
        }
        for name in names(format) {
            let read = |folder: &tempfile::TempDir| fs::read(folder.path().join(&name)).unwrap();
            assert!(read(&one) == read(&two), "{name}");
        }
    }
}

#[test]
fn the_default_frame_is_right_to_a_centimetre_in_267_cycles() {
    let folder = empty();
    let run = json(folder.path(), &["run", "--json"]);
    assert_eq!(run["schema"], "tofsim.run/1");
    assert_eq!((run["scenario"].as_str(), run["seed"].as_u64()), (Some("kc705"), Some(1)));
    assert_eq!(
        (run["fidelity"].as_str(), run["waves"].as_str()),
        (Some("cycle"), Some("waves/kc705.vcd"))
    );
    let frame = &run["frames"][0];
    let depth_m = frame["depth_m"].as_f64().unwrap();
    assert!((depth_m - 0.5).abs() < 0.01, "{depth_m}");
    assert_eq!(frame["estimator_cycles"], 267);
    assert_eq!(frame["shots"], 30_000);
    assert_eq!(frame["true_depth_m"], 0.5);
    let counts = frame["histogram"].as_array().unwrap();
    assert_eq!(counts.len(), 256);
    assert_eq!(
        counts.iter().map(|c| c.as_u64().unwrap()).sum::<u64>(),
        frame["hits"].as_u64().unwrap()
    );
    let raw = u64::from_str_radix(frame["depth_raw"].as_str().unwrap(), 16).unwrap();
    assert_eq!(raw as f64 / (1u64 << 29) as f64, depth_m);
}

#[test]
fn frame_cycles_follow_the_formula_at_every_rate() {
    let folder = empty();
    for (laser_freq, period) in [(0, 25), (1, 13), (2, 8), (3, 6)] {
        for shots in [1, 300] {
            let freq = format!("firmware.laser_freq={laser_freq}");
            let count = format!("firmware.shots_per_frame={shots}");
            let args =
                ["run", "--json", "--waves", "none", "--frames", "3", "-s", &freq, "-s", &count];
            for frame in json(folder.path(), &args)["frames"].as_array().unwrap() {
                assert_eq!(frame["frame_cycles"], shots * period + 541);
            }
        }
    }
    let preloaded =
        json(folder.path(), &["run", "estimator_validation", "--json", "--waves", "none"]);
    assert_eq!(preloaded["frames"][0]["frame_cycles"], 524);
}

#[test]
fn the_tdc_validation_reproduces_table_6_3() {
    let tdc = &json(empty().path(), &["run", "tdc_validation", "--json", "--waves", "none"])["tdc"];
    let expected = serde_json::json!([
        { "t2_ps": 2000.0, "n": 328, "t1_ns": 8, "valid": true },
        { "t2_ps": 4000.0, "n": 154, "t1_ns": 8, "valid": true },
        { "t2_ps": 8000.0, "n": 492, "t1_ns": 16, "valid": false },
    ]);
    assert_eq!(*tdc, expected);
}

#[test]
fn preloaded_codes_and_histograms_arrive_unchanged() {
    let folder = empty();
    let run = |name: &str| json(folder.path(), &["run", name, "--json", "--waves", "none"]);
    let (board, codes, histogram) =
        (run("kc705"), run("histogram_validation"), run("estimator_validation"));
    let histogram_of = |run: &serde_json::Value| run["frames"][0]["histogram"].clone();
    assert_eq!(histogram_of(&codes), histogram_of(&board), "codes were those of kc705, seed 1");
    assert_eq!(histogram_of(&histogram), histogram_of(&board));
    for run in [&codes, &histogram] {
        assert_eq!(run["frames"][0]["depth_raw"], board["frames"][0]["depth_raw"]);
    }
}

#[test]
fn a_folder_receives_summary_histogram_picture_and_waveform() {
    let folder = empty();
    let table = stdout(folder.path(), &["run", "-o", "out", "--events", "out/shots.csv"]);
    for word in
        ["true depth", "estimated", "shots", "codes", "267 cycles", "on the board", "per second"]
    {
        assert!(table.contains(word), "{word}: {table}");
    }
    let out = folder.path().join("out");
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let csv = fs::read_to_string(out.join("histogram.csv")).unwrap();
    let counts: Vec<u64> =
        csv.lines().skip(2).map(|row| row.split_once(',').unwrap().1.parse().unwrap()).collect();
    assert!(csv.starts_with("# tofsim-record {") && csv.contains("}\nbin,count\n0,"));
    assert_eq!(serde_json::json!(counts), summary["frames"][0]["histogram"]);
    let svg = fs::read_to_string(out.join("histogram.svg")).unwrap();
    for word in ["signal", "ambient", "peak", "true", "estimated", "[ns]", "[m]"] {
        assert!(svg.contains(word), "{word}");
    }
    let estimate = json(&out, &["estimate", "histogram.csv", "--json"]);
    assert_eq!(estimate["depth_raw"], summary["frames"][0]["depth_raw"]);

    let mut events = csv::ReaderBuilder::new();
    let events = events.comment(Some(b'#')).from_path(out.join("shots.csv"));
    let mut events = events.unwrap();
    let header = ["frame", "shot", "arrival_ps", "cause", "n", "coarse", "code", "bin"];
    assert_eq!(events.headers().unwrap(), &header[..]);
    let mut seen = vec![0u64; 256];
    for (shot, row) in events.records().enumerate() {
        let row = row.unwrap();
        assert_eq!(row[1].parse(), Ok(shot));
        if let Ok(code) = row[6].parse::<usize>() {
            seen[code] += 1;
            let arrival_ps: f64 = row[2].parse().unwrap();
            assert!((arrival_ps / 25.0 - code as f64 - 0.5).abs() < 1.0, "{row:?}");
            assert!(["signal", "ambient", "dark"].contains(&&row[3]), "{row:?}");
        }
    }
    assert_eq!(seen, counts);
}

#[test]
fn many_frames_give_mean_and_spread() {
    let folder = empty();
    let run = json(folder.path(), &["run", "--json", "--waves", "none", "--frames", "5"]);
    let depths: Vec<f64> =
        run["frames"].as_array().unwrap().iter().map(|f| f["depth_m"].as_f64().unwrap()).collect();
    assert_eq!(depths.len(), 5);
    let mean = depths.iter().sum::<f64>() / 5.0;
    let sd = (depths.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 4.0).sqrt();
    assert!((run["depth"]["mean_m"].as_f64().unwrap() - mean).abs() < 1e-12);
    assert!((run["depth"]["two_sd_m"].as_f64().unwrap() - 2.0 * sd).abs() < 1e-12);
    assert_eq!(run["depth"]["true_depth_m"], 0.5);
    let error_m = run["depth"]["mean_error_m"].as_f64().unwrap();
    assert!((error_m - (mean - 0.5)).abs() < 1e-12);
    assert_eq!(run["depth"]["outliers"], 0);
    let first = json(folder.path(), &["run", "--json", "--waves", "none"]);
    assert_eq!(run["frames"][0], first["frames"][0], "a frame does not depend on how many follow");
}

#[test]
fn the_budget_has_the_designs_numbers() {
    let budget = json(empty().path(), &["budget", "--json", "-s", "target.reflectance=0.6"]);
    let number = |key: &str| budget[key].as_f64().unwrap();
    assert!((number("signal_per_shot") / 1.577 - 1.0).abs() < 1e-3);
    assert!((number("noise_rate_hz") / (3.968e9 * 0.2 * 0.6) - 1.0).abs() < 1e-3);
    assert!((number("eye_safety_limit_w") / 12.77e-3 - 1.0).abs() < 1e-3);
    assert!((number("pulse_energy_j") / 184e-12 - 1.0).abs() < 1e-3);
    assert!((number("average_power_w") / (184e-12 * 125e6 / 6.0) - 1.0).abs() < 1e-3);
    assert_eq!(number("dark_rate_hz"), 100.0);
}

#[test]
fn scenarios_are_listed_shown_checked_and_described() {
    let folder = empty();
    let list = stdout(folder.path(), &["scenario", "list"]);
    for name in ["kc705", "near", "far", "bright", "spad_validation", "tdc_validation"] {
        assert!(list.contains(name));
    }
    let shown = stdout(folder.path(), &["scenario", "show", "far"]);
    fs::write(folder.path().join("mine.toml"), &shown).unwrap();
    assert_eq!(shown, stdout(folder.path(), &["scenario", "show", "mine.toml"]));
    assert_eq!(stdout(folder.path(), &["scenario", "check", "mine.toml"]), "mine: ok\n");
    assert!(json(folder.path(), &["scenario", "schema"])["properties"]["target"].is_object());
}

#[test]
fn completions_and_manual_pages_are_made() {
    let folder = empty();
    for shell in ["bash", "zsh", "fish"] {
        assert!(stdout(folder.path(), &["completions", shell]).contains("tofsim"));
    }
    let script = stdout(folder.path(), &["completions", "bash"]);
    fs::write(folder.path().join("tofsim.bash"), script).unwrap();
    for (words, expected) in [
        ("run kc", "kc705"),
        ("run kc705 -s target.dist", "target.distance_m="),
        ("run --set tdc.prof", "tdc.profile="),
        ("sweep fig-4-4", "fig-4-4a fig-4-4b fig-4-4c fig-4-4d"),
        ("verify --block frame", "frame_ctrl"),
        ("vectors coarse", "coarse_counter"),
        ("build ec", "ecp5"),
        ("estimate --network uniform-", "uniform-16"),
        ("train --profile kin", "kintex7"),
        ("reproduce fig-6.21", "fig-6.21"),
    ] {
        let script = format!(
            "compopt() {{ :; }}; . ./tofsim.bash; COMP_WORDS=(tofsim {words}); \
             COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); cur=${{COMP_WORDS[COMP_CWORD]}}; \
             _tofsim_with_keys tofsim \"$cur\" \"${{COMP_WORDS[COMP_CWORD-1]}}\"; echo \"${{COMPREPLY[@]}}\""
        );
        let mut bash = std::process::Command::new("bash");
        let output = bash.args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected, "{words}");
    }
    assert!(stdout(folder.path(), &["man"]).contains(".TH tofsim"));
    stdout(folder.path(), &["man", "-o", "man1"]);
    assert!(files(&folder.path().join("man1")).contains(&"tofsim-run.1".to_owned()));
}
