//! Shared helpers of the tests.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::fmt::Write;
use std::fs;
use std::path::Path;

use tofsim::network::Histogram;
use tofsim::{Frame, Run, Setup};

/// Oscillators with which clk_sys is of 125, 112.5, 143.75 and 162.5 MHz. The default first; the periods of the
/// others are no whole picoseconds.
pub const CLOCKS: [&str; 4] = [
    "pll.input_hz=200000000",
    "pll.input_hz=180000000",
    "pll.input_hz=230000000",
    "pll.input_hz=260000000",
];

/// A scenario with overrides, ready to run.
pub fn setup(name: &str, overrides: &[&str]) -> Setup {
    Setup::load(name, overrides).unwrap()
}

/// The first `count` frames of a setup.
pub fn frames(setup: &Setup, count: u64) -> Vec<Frame> {
    let frames = Run::new(setup).frames(count).unwrap();
    assert_eq!(frames.len() as u64, count);
    frames
}

/// Chains and calibrations that differ: equal taps, an uneven chain in order, and one whose taps are reached out of
/// order, with a ROM of each kind, the last of which is not in order of age.
pub const CONVERTERS: [[&str; 2]; 6] = [
    ["uniform", "true"],
    ["table6_3", "true"],
    ["ideal", "true"],
    ["kintex7", "true"],
    ["kintex7", "uniform"],
    ["kintex7", "jumbled"],
];

/// The keys of one of [`CONVERTERS`]; a file that it needs is written into `folder`.
pub fn converter([chain, calibration]: [&str; 2], folder: &Path) -> [String; 2] {
    let profile = format!("tdc.profile={chain}");
    if calibration != "jumbled" {
        return [profile, format!("tdc.calibration={calibration}")];
    }
    let delays = setup("kc705", &[&profile]).params.tdc.delays;
    let mut text = String::from("n,age_ps,age_se_ps\n");
    for n in 0..=delays.taps() {
        let jumble = (n * 37 % 11) as f64 * 20.0;
        writeln!(text, "{n},{},0", delays.boundary(n).fs() as f64 * 1e-3 + jumble).unwrap();
    }
    let path = folder.join("jumbled.csv");
    fs::write(&path, text).unwrap();
    [profile, format!("tdc.calibration={:?}", path.display().to_string())]
}

/// Names of the files in a folder, hidden ones too.
pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .map(|entries| entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect())
        .unwrap_or_default();
    names.sort();
    names
}

/// A histogram as CSV with a comment.
pub fn csv(histogram: &Histogram) -> String {
    let mut text = String::from("# made by hand\nbin,count\n");
    for (bin, count) in histogram.iter().enumerate() {
        writeln!(text, "{bin},{count}").unwrap();
    }
    text
}

/// An `.npy` file of that type and shape, by the format's description.
pub fn npy(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let dict = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{dict:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// A folder with nothing in it, gone at the end of the test.
pub fn empty() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}
