//! Progress and colour, on a terminal and in a pipe.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use crate::common::{empty, output};

/// Returns the program's output on a terminal of 80 columns, both streams.
#[cfg(target_os = "linux")]
fn on_terminal(folder: &Path, line: &str, environment: &[(&str, &str)]) -> String {
    let program = env!("CARGO_BIN_EXE_tofsim");
    let script = format!("stty cols 80 rows 24; exec {program} {line}");
    let mut command = Command::new("script");
    command.current_dir(folder).args(["-q", "-e", "-c", &script, "/dev/null"]);
    command.env_remove("NO_COLOR").env("TERM", "xterm").envs(environment.iter().copied());
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}");
    text
}

/// The lines as they stand, without what moves the cursor or changes the colour.
#[cfg(target_os = "linux")]
fn lines(shown: &str) -> Vec<String> {
    let mut text = String::new();
    let mut letters = shown.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '\x1b' => drop(letters.find(|letter| letter.is_ascii_alphabetic())),
            letter => text.push(letter),
        }
    }
    text.split(['\r', '\n']).map(str::to_owned).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn a_bar_moves_and_fits_80_columns() {
    let folder = empty();
    let stages = "--with 'stages=[{candidates=2,epochs=20,samples=402}]'";
    let end = "--with finish.blocks=0 --with checkpoint_epochs=20";
    let line = format!("train --quick {stages} {end} -o t");
    let shown = on_terminal(folder.path(), &line, &[]);
    let lines = lines(&shown);
    let longest = lines.iter().map(|line| line.chars().count()).max();
    assert!(longest <= Some(80), "{longest:?}: {shown}");
    let before = lines.iter().take_while(|line| !line.contains("stage 0"));
    let bars: BTreeSet<_> = before.filter(|line| line.contains(" %")).collect();
    assert!(bars.len() > 8, "it moves before the first checkpoint: {shown}");
    assert!(!lines.iter().any(|line| line.contains(" 0.0 %, 0 s to go")), "{shown}");
}

#[cfg(target_os = "linux")]
#[test]
fn verdicts_have_colours_on_a_terminal_unless_the_user_minds() {
    let folder = empty();
    let verify = "verify --block reset_sync";
    let shown = on_terminal(folder.path(), verify, &[]);
    assert_eq!(shown.matches("\x1b[32mpass\x1b[0m").count(), 2, "{shown:?}");
    for environment in [[("NO_COLOR", "1")], [("TERM", "dumb")]] {
        let shown = on_terminal(folder.path(), verify, &environment);
        assert!(!shown.contains("\x1b[3") && shown.contains("pass"), "{shown:?}");
    }
    let piped = output(folder.path(), &["verify", "--block", "reset_sync"]);
    assert!(!piped.stdout.contains(&0x1b) && !piped.stderr.contains(&0x1b));
}

#[test]
fn every_block_has_a_line_when_it_is_done() {
    let folder = empty();
    let args = ["verify", "--block", "pll", "--block", "reset_sync", "--cycles", "500"];
    let error = String::from_utf8(output(folder.path(), &args).stderr).unwrap();
    assert!(error.contains("pll: pass\n") && error.contains("reset_sync: pass\n"), "{error}");
}

#[test]
fn an_exploration_fits_80_columns_where_there_is_no_terminal() {
    let folder = empty();
    let output = output(folder.path(), &["quantize", "--explore", "uniform", "--rows", "51"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let longest = text.lines().map(|line| line.chars().count()).max();
    assert!(longest <= Some(80), "{longest:?}: {text}");
    let summary = text.find("built: the network's own").unwrap();
    assert!(summary < text.find("datapath").unwrap(), "{text}");
}

#[cfg(target_os = "linux")]
#[test]
fn notes_and_errors_fit_the_terminal() {
    let folder = empty();
    let shown = on_terminal(folder.path(), "budget -s laser.average_power_w=0.1 >/dev/null", &[]);
    let lines = lines(&shown);
    assert!(lines.iter().any(|line| line.starts_with("note: laser.average_power_w")), "{shown}");
    let longest = lines.iter().map(|line| line.chars().count()).max();
    assert!(longest <= Some(80), "{longest:?}: {shown}");
    let piped = output(folder.path(), &["budget", "-s", "laser.average_power_w=0.1"]);
    let notes = String::from_utf8(piped.stderr).unwrap();
    assert!(notes.lines().all(|line| line.starts_with("note: ")), "{notes}");
}
