//! Nothing is done twice, and what depends on a change is done again.

use std::fs;

use super::{ALONE, SMALL, build, journal, small};

/// Steps that a build did, of what it said.
fn done(said: &str) -> Vec<&str> {
    said.lines()
        .filter_map(|line| {
            line.split_once(": ")?.1.ends_with(" s)").then_some(line.split_once(": ")?.0)
        })
        .collect()
}

#[test]
fn a_build_goes_on_where_it_was_and_follows_each_change() {
    let folder = small();
    let path = folder.path();
    let (status, said) = build(path, &["--steps", "network,verilog"]);
    assert_eq!((status, done(&said)), (0, vec!["network", "verilog"]), "{said}");
    let (status, said) = build(path, &["--steps", ALONE]);
    let rest = ["constraints", "vectors", "frame", "accuracy", "report"];
    assert_eq!((status, done(&said)), (0, rest.to_vec()), "{said}");
    let page = fs::read(path.join("out/report.html")).unwrap();
    let (status, said) = build(path, &["--steps", ALONE]);
    assert_eq!((status, done(&said)), (0, vec![]), "{said}");

    // What is gone or was changed by hand is made again, and nothing else.
    fs::remove_file(path.join("out/rtl/w1.mem")).unwrap();
    fs::write(path.join("out/frame/summary.json"), "{}").unwrap();
    let (status, said) = build(path, &["--steps", ALONE]);
    assert_eq!((status, done(&said)), (0, vec!["verilog", "frame"]), "{said}");
    assert!(path.join("out/rtl/w1.mem").exists());
    assert!(fs::read(path.join("out/report.html")).unwrap() == page, "the same bytes");

    // Pins and clocks do not depend on the scene.
    fs::write(path.join("small.toml"), SMALL.replace("\"0.2,0.5\"", "\"0.2,0.6\"")).unwrap();
    let (status, said) = build(path, &["--steps", ALONE]);
    let changed = ["network", "verilog", "vectors", "frame", "accuracy", "report"];
    assert_eq!((status, done(&said)), (0, changed.to_vec()), "{said}");
    fs::write(path.join("small.toml"), SMALL.replace("A small", "Another")).unwrap();
    build(path, &["--steps", ALONE]);
    let (_, said) = build(path, &["--steps", ALONE, "--force"]);
    assert_eq!(done(&said).len(), 7, "{said}");
}

#[test]
fn two_builds_are_the_same_to_the_byte() {
    let (one, two) = (small(), small());
    let all = |folder: &tempfile::TempDir, threads: &str| {
        build(folder.path(), &["--steps", "network,verilog,frame,report", "--threads", threads]);
        ["build.json", "network.toml", "report.html", "frame/small.vcd", "rtl/instrument.v"]
            .map(|name| fs::read(folder.path().join("out").join(name)).unwrap())
    };
    assert!(all(&one, "1") == all(&two, "2"));
}

#[test]
fn a_network_of_ones_own_is_taken_if_it_fits() {
    let folder = small();
    let path = folder.path();
    build(path, &["--steps", "network"]);
    assert_eq!(journal(path)["steps"]["network"]["result"]["how"], "trained");
    fs::copy(path.join("out/network.toml"), path.join("own.toml")).unwrap();
    let own = format!("{SMALL}[estimator]\nnetwork = \"./own.toml\"\n");
    fs::write(path.join("small.toml"), &own).unwrap();
    build(path, &["--steps", "network"]);
    assert_eq!(journal(path)["steps"]["network"]["result"]["from"], "./own.toml");
    fs::write(path.join("small.toml"), own.replace("neurons = 2", "neurons = 3")).unwrap();
    build(path, &["--steps", "network"]);
    let result = &journal(path)["steps"]["network"]["result"];
    assert_eq!(result["because"], "./own.toml has 2 neurons and not 3");
    assert_eq!(result["neurons"], 3);
}
