//! `-q`, the list of files that were written, and `help`.

use std::fs;

use crate::common::{empty, files, output, refused, short_run, stdout};

#[test]
fn quiet_prints_nothing_but_errors_and_what_json_asks_for() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("h.csv"), histogram()).unwrap();
    let run = short_run(&["-q", "-o", "out", "--frames", "3"]);
    let commands: [&[&str]; 8] = [
        &run,
        &["budget", "-q"],
        &["estimate", "-q", "h.csv"],
        &["scenario", "check", "-q"],
        &["vectors", "pll", "-o", "v", "-q"],
        &["verify", "--block", "pll", "-q"],
        &["dataset", "--rows", "51", "-o", "d", "-q"],
        &["evaluate", "--rows", "51", "--check", "0", "-o", "e", "-q"],
    ];
    for args in commands {
        let output = output(path, args);
        assert!(output.status.success(), "{args:?}");
        let [out, error] =
            [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert_eq!((out.as_str(), error.as_str()), ("", ""), "{args:?}");
    }
    assert!(refused(path, &["budget", "-q", "none"]).contains("none"));
    assert!(stdout(path, &["budget", "-q", "--json"]).starts_with('{'));
}

#[test]
fn files_that_were_written_are_listed_on_standard_error() {
    let folder = empty();
    let path = folder.path();
    let listed = |args: &[&str], wanted: &[&str]| {
        let output = output(path, args);
        assert!(output.status.success(), "{args:?}");
        let error = String::from_utf8(output.stderr).unwrap();
        for file in wanted {
            assert!(error.contains(&format!("wrote {file}\n")), "{args:?} {file}: {error}");
            assert!(path.join(file).is_file(), "{file}");
        }
        let all = error.lines().filter(|line| line.starts_with("wrote ")).count();
        assert!(all >= wanted.len());
    };
    let run = short_run(&["-o", "out"]);
    listed(&run, &["out/kc705.vcd", "out/kc705.gtkw", "out/summary.json", "out/histogram.csv"]);
    listed(&["vectors", "pll", "-o", "v"], &["v/pll/stimulus.mem", "v/pll/tb_pll.v"]);
    listed(&["dataset", "--rows", "51", "-o", "d"], &["d/dataset.json"]);
    let evaluate = ["evaluate", "--rows", "51", "--check", "0", "-o", "e"];
    listed(&evaluate, &["e/evaluation.json", "e/evaluation.csv"]);
    listed(&["man", "-o", "m"], &["m/tofsim.1", "m/tofsim-run.1"]);
    listed(
        &["compare", "out/kc705.vcd", "out/kc705.vcd", "--waves", "w.vcd", "--junit", "j.xml"],
        &["w.vcd", "w.gtkw", "j.xml"],
    );
    let capture = ["ila", "capture", "--probes", "fig_6_6", "-o", "i"];
    listed(&capture, &["i/fig_6_6.csv", "i/fig_6_6.map.toml"]);
}

#[test]
fn help_is_a_command_too_and_no_page_of_the_manual() {
    let folder = empty();
    let path = folder.path();
    assert_eq!(stdout(path, &["help"]), stdout(path, &["--help"]));
    assert_eq!(stdout(path, &["help", "run"]), stdout(path, &["run", "--help"]));
    assert!(stdout(path, &["help", "ila", "capture"]).contains("--probes"));
    stdout(path, &["man", "-o", "m"]);
    let pages = files(&path.join("m"));
    assert!(pages.iter().all(|page| !page.contains("help")), "{pages:?}");
    assert!(!stdout(path, &["completions", "bash"]).contains("tofsim__help__"));
}

fn histogram() -> String {
    let rows = (0..256).map(|bin| format!("{bin},{}\n", if bin == 100 { 900 } else { 20 }));
    "bin,count\n".to_owned() + &rows.collect::<String>()
}
