//! Input without measure: long values, many frames, pipes that nobody writes into.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{empty, refused, short_run, tofsim};

#[test]
fn a_value_of_50_000_characters_is_not_echoed_whole() {
    let folder = empty();
    let path = folder.path();
    let long = "x".repeat(50_000);
    let with = |text: &str| text.replace('X', &long);
    let commands: [&[&str]; 22] = [
        &["X"],
        &["run", "X"],
        &["run", "--X"],
        &["run", "-s", "X"],
        &["run", "-s", "X=1"],
        &["run", "-s", "target.distance_m=X"],
        &["run", "-s", "control=[{X=1}]"],
        &["run", "-s", "estimator.network=X"],
        &["run", "--frames", "X"],
        &["run", "--waves", "X"],
        &["run", "--window", "X"],
        &["run", "--signals", "X"],
        &["run", "--estimator", "X"],
        &["run", "-o", "X"],
        &["estimate", "X"],
        &["train", "--with", "X"],
        &["train", "--with", "table_noise=X"],
        &["train", "--format", "X"],
        &["compare", "a", "b", "--align", "X"],
        &["compare", "a", "b", "--tolerance", "X"],
        &["completions", "X"],
        &["quantize", "--explore", "X"],
    ];
    for args in commands {
        let args: Vec<_> = args.iter().map(|arg| with(arg)).collect();
        let args: Vec<_> = args.iter().map(String::as_str).collect();
        let error = refused(path, &args);
        let head = &error[..error.len().min(300)];
        assert!(error.len() < 3_000, "{} characters: {head}", error.len());
    }
    fs::write(path.join("s.toml"), with("[target]\nX = 1\n")).unwrap();
    assert!(refused(path, &["run", "s.toml"]).len() < 3_000);
}

#[test]
fn more_frames_than_time_has_room_for_are_refused_with_the_reason() {
    let folder = empty();
    let frames = ["--frames", "18446744073709551615"];
    for args in [&["run"][..], &["run", "--fidelity", "shot"]] {
        let error = refused(folder.path(), &[args, &frames].concat());
        assert!(error.contains("--frames: 18446744073709551615: expected 1"), "{error}");
        assert!(error.contains("at most: simulated time"), "{error}");
    }
    let drawn = ["run", "--fidelity", "histogram"];
    let error = refused(folder.path(), &[&drawn[..], &frames].concat());
    assert!(error.contains("random numbers of their own"), "{error}");
    let capture = ["ila", "capture", "--probes", "fig_6_6", "-o", "out"];
    assert!(refused(folder.path(), &[&capture[..], &frames].concat()).contains("simulated time"));
}

#[test]
fn an_evaluation_looks_at_its_folder_before_its_work() {
    let folder = empty();
    fs::write(folder.path().join("file"), "").unwrap();
    let begun = Instant::now();
    // All 121,635 rows would take longer.
    assert!(refused(folder.path(), &["evaluate", "-o", "file"]).contains("file: cannot create"));
    assert!(begun.elapsed() < Duration::from_secs(5));
}

#[cfg(unix)]
#[test]
fn a_pipe_is_a_file_if_somebody_writes_into_it() {
    let folder = empty();
    let path = folder.path();
    assert!(Command::new("mkfifo").arg(path.join("pipe")).status().unwrap().success());
    let error = refused(path, &["run", "./pipe"]);
    assert!(error.contains("pipe: is a pipe; expected somebody to write into it"), "{error}");

    let mut child = tofsim(path, &short_run(&["/dev/stdin", "--waves", "none", "--json"]))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"[target]\ndistance_m = 0.3\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(String::from_utf8(output.stdout).unwrap().contains("0.3"));
}

#[cfg(unix)]
#[test]
fn a_link_to_itself_is_refused() {
    let folder = empty();
    let path = folder.path();
    std::os::unix::fs::symlink("loop", path.join("loop")).unwrap();
    for args in [&["run", "./loop"][..], &["estimate", "loop"], &["compare", "loop", "loop"]] {
        assert!(refused(path, args).contains("loop: cannot read"), "{args:?}");
    }
    assert!(refused(path, &["vectors", "pll", "-o", "loop"]).contains("loop: cannot create"));
}
