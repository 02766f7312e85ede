//! `tofsim serve` checks what it is told, and becomes the program that lies beside it.

use std::fs;
use std::io::ErrorKind;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};
use std::thread;
use std::time::Duration;

use crate::common::empty;

/// A program `tofsim` in a folder of its own, and what it says to those arguments.
fn serve(folder: &Path, arguments: &[&str]) -> Output {
    let program = folder.join("tofsim");
    if !program.exists() {
        fs::copy(env!("CARGO_BIN_EXE_tofsim"), &program).unwrap();
    }
    // While another test begins a program of its own, that holds on to what has just been written.
    loop {
        match Command::new(&program).arg("serve").args(arguments).output() {
            Err(error) if error.kind() == ErrorKind::ExecutableFileBusy => {}
            Ok(output) if String::from_utf8_lossy(&output.stderr).contains("Text file busy") => {}
            output => return output.unwrap(),
        }
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn without_its_program_it_says_how_to_build_it() {
    let folder = empty();
    let output = serve(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let fault = String::from_utf8(output.stderr).unwrap();
    assert!(
        fault.contains("is missing: build it with `cargo build --release -p tofsim-serve`"),
        "{fault}"
    );
    let output = serve(folder.path(), &["nowhere"]);
    assert_eq!(output.status.code(), Some(2), "what is wrong comes first");
}

#[test]
fn its_program_is_told_what_it_was_told() {
    let folder = empty();
    let program = folder.path().join("tofsim-serve");
    fs::write(&program, "#!/bin/sh\nprintf '%s\\n' \"$@\"\nexit 7\n").unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let given = [
        "far",
        "-s",
        "target.reflectance=0.6",
        "--seed",
        "3",
        "--fidelity",
        "shot",
        "--port",
        "8080",
        "--rate",
        "5",
        "--stopped",
        "--json",
        "-q",
    ];
    let output = serve(folder.path(), &given);
    assert_eq!(output.status.code(), Some(7));
    let told = String::from_utf8(output.stdout).unwrap();
    let expected = [
        "--fidelity=shot",
        "--port=8080",
        "--rate=5",
        "--set=target.reflectance=0.6",
        "--seed=3",
        "--without-notes",
        "--stopped",
        "--json",
        "--quiet",
        "--",
        "far",
    ];
    assert_eq!(told.lines().collect::<Vec<_>>(), expected);
}
