//! `examples/board`: the firmware in Verilator as a board, with `tofsim board` and LiteX's own tools as its host.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use crate::common;

/// Two more than are between two calibrations.
const FRAMES: usize = 6;
/// Keys of a frame that a board and a run have alike.
const KEYS: [&str; 8] =
    ["index", "depth_raw", "depth_m", "sigma_m", "valid", "status", "shots", "histogram"];

/// A board on a pseudo-terminal.
struct Board {
    child: Child,
    folder: TempDir,
    set: Vec<&'static str>,
}

impl Board {
    /// Builds a board of the scenario kc705 with short frames, and waits until it has a port.
    fn start(baud: u32, set: &[&'static str]) -> Board {
        let folder = common::empty();
        let set: Vec<_> = ["firmware.shots_per_frame=300"]
            .iter()
            .chain(set)
            .flat_map(|key| ["-s", key])
            .collect();
        let mut child = Command::new("python3")
            .arg(root().join("examples/board/board.py"))
            .args(&set)
            .args(["--baud", &baud.to_string(), "--link", "port", "--build", "build"])
            .args(["--tofsim", env!("CARGO_BIN_EXE_tofsim")])
            .arg("--lib")
            .arg(std::env::current_exe().unwrap().parent().unwrap())
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("python3: apt-get install python3");
        let mut errors = child.stderr.take().unwrap();
        let errors = std::thread::spawn(move || {
            let mut text = Vec::new();
            let _ = errors.read_to_end(&mut text);
            String::from_utf8_lossy(&text).into_owned()
        });
        let mut port = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut port).unwrap();
        if port.is_empty() {
            child.wait().unwrap();
            panic!("{}", errors.join().unwrap());
        }
        Board { child, folder, set }
    }

    /// Runs a verb on the scenario of the board.
    fn tofsim(&self, args: &[&str]) -> String {
        common::stdout(self.folder.path(), &[args, &self.set].concat())
    }

    fn frames(&self, args: &[&str]) -> Vec<Value> {
        let frames = FRAMES.to_string();
        let text = self.tofsim(&[args, &["--frames", &frames, "--json"]].concat());
        let run: Value = serde_json::from_str(&text).unwrap();
        run["frames"].as_array().unwrap().clone()
    }

    /// Takes frames from the board, and compares them with those of a run.
    fn check(&self) {
        let run = self.frames(&["run", "--waves", "none", "--no-second-opinion"]);
        let host =
            ["board", "run", "--port", "port", "--laser", "--timeout", "60", "--no-second-opinion"];
        let board = self.frames(&host);
        assert_eq!(board.len(), FRAMES);
        for (board, run) in board.iter().zip(&run) {
            for key in KEYS {
                assert_eq!(board[key], run[key], "frame {}: {key}", run["index"]);
            }
        }
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

#[test]
#[ignore = "long: ./check --full"]
fn frames_of_the_network_are_those_of_a_run_for_tofsim_and_for_litex() {
    let mut board = Board::start(921_600, &[]);
    board.check();

    let python = root().join("target/litex-tools/bin/python");
    assert!(python.exists(), "no {}: ./check --full installs LiteX into it", python.display());
    board.tofsim(&["board", "csr", "-o", "csr.csv"]);
    // The second release of dsp_rst begins with frame 0 again.
    let litex = Command::new(python)
        .arg(root().join("examples/board/litex_host.py"))
        .args(["--port", "port", "--csr", "csr.csv", "--frames", "3"])
        .current_dir(board.folder.path())
        .output()
        .unwrap();
    assert!(litex.status.success(), "{}", String::from_utf8_lossy(&litex.stderr));
    let litex: Value = serde_json::from_slice(&litex.stdout).unwrap();
    assert_eq!(litex["identity"], "746f6673");
    let run = board.frames(&["run", "--waves", "none", "--no-second-opinion"]);
    for (number, frame) in litex["frames"].as_array().unwrap().iter().enumerate() {
        for key in ["depth_raw", "histogram"] {
            assert_eq!(frame[key], run[number][key], "LiteX: frame {number}: {key}");
        }
    }

    // The end of its standard input ends the board, and its link.
    drop(board.child.stdin.take());
    assert!(board.child.wait().unwrap().success());
    assert!(fs::symlink_metadata(board.folder.path().join("port")).is_err());
}

#[test]
#[ignore = "long: ./check --full"]
fn frames_of_the_likelihood_estimator_are_those_of_a_run() {
    Board::start(5_000_000, &["estimator.kind=likelihood"]).check();
}

/// In MODE 1 the SPAD takes what it has left from one frame to the next, so that waiting must not count.
#[test]
#[ignore = "long: ./check --full"]
fn frames_of_a_board_that_calibrates_itself_are_those_of_a_run() {
    Board::start(
        5_000_000,
        &["tdc.recalibrate_frames=4", "tdc.profile=kintex7", "firmware.mode=1"],
    )
    .check();
}
