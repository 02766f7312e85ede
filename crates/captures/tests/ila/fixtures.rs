//! The fixtures: files written by hand as Vivado and chipscopy write them.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::fs;
use std::path::{Path, PathBuf};

use crate::ila::archive;

/// A fixture's path.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ila").join(name)
}

/// A fixture's bytes.
pub fn bytes(name: &str) -> Vec<u8> {
    fs::read(fixture(name)).unwrap()
}

/// The parts of an archive.
pub const PARTS: [&str; 4] = ["waveform.csv", "waveform.dmp", "waveform.vcd", "probes.ltx"];

/// The files of the archive, with those of `but` exchanged or, if empty, left out.
pub fn archive_but(but: &[(&str, &[u8])]) -> Vec<u8> {
    packed("archive", but)
}

/// The same of a System ILA's: a port with slices of its own names, words among numbers, a view of
/// other probes that is not in the dump.
pub fn views_but(but: &[(&str, &[u8])]) -> Vec<u8> {
    packed("views", but)
}

fn packed(folder: &str, but: &[(&str, &[u8])]) -> Vec<u8> {
    let entries = PARTS.map(|name| {
        let other = but.iter().find(|(other, _)| *other == name);
        let own = || fs::read(fixture(folder).join(name)).unwrap_or_default();
        (name, other.map_or_else(own, |(_, bytes)| bytes.to_vec()))
    });
    let kept = entries.iter().filter(|(_, content)| !content.is_empty());
    let kept: Vec<_> = kept.map(|(name, content)| (*name, &content[..])).collect();
    archive(&kept)
}
