//! The rows of the table "Commands" in `README.md` run as printed, for a reader who has only a clone.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::build::is_whole;
use crate::common::{empty, output, tofsim};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Returns the arguments of each `tofsim` command in the first column of the table "Commands".
fn rows() -> Vec<Vec<String>> {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    let (_, section) = readme.split_once("\n## Commands\n").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    (section.lines())
        .filter_map(|line| line.strip_prefix("| `tofsim ")?.split_once("` |"))
        .map(|(command, _)| command.split_whitespace().map(str::to_owned).collect())
        .collect()
}

/// Starts the page, reads it, and stops it with Ctrl-C.
fn serve(folder: &Path, args: &[&str]) {
    let server = Path::new(env!("CARGO_BIN_EXE_tofsim")).with_file_name("tofsim-serve");
    assert!(server.is_file(), "build it with `cargo build -p tofsim-serve`, in this profile");
    let mut command = tofsim(folder, args);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut url = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
    let (host, path) = url.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
    let mut stream = TcpStream::connect(host).unwrap();
    write!(stream, "GET /{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn the_row_of_serve_says_how_its_program_is_built() {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    let row = readme.lines().find(|line| line.starts_with("| `tofsim serve` |")).unwrap();
    assert!(row.contains("`cargo build --release -p tofsim-serve`"), "{row}");
}

#[test]
#[ignore = "long: ./check --full"]
fn every_command_of_the_readme_runs_as_printed() {
    let rows = rows();
    assert!(rows.len() >= 20, "{} rows", rows.len());
    let clone = empty();
    symlink(Path::new(ROOT).join("rtl_ref"), clone.path().join("rtl_ref")).unwrap();
    for row in &rows {
        let args: Vec<&str> = row.iter().map(String::as_str).collect();
        if args[0] == "serve" {
            serve(clone.path(), &args);
            continue;
        }
        let output = output(clone.path(), &args);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "tofsim {}: {error}", args.join(" "));
    }
    let journal = fs::read_to_string(clone.path().join("mine/build.json")).unwrap();
    is_whole(&serde_json::from_str(&journal).unwrap());
}
