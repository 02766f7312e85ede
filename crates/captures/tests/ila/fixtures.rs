//! Fixtures: files written by hand in the formats of Vivado and chipscopy.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::fs;
use std::path::{Path, PathBuf};

use crate::ila::archive;

/// Returns a fixture's path.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ila").join(name)
}

/// Returns a fixture's bytes.
pub fn bytes(name: &str) -> Vec<u8> {
    fs::read(fixture(name)).unwrap()
}

/// Names of an archive's parts.
pub const PARTS: [&str; 4] = ["waveform.csv", "waveform.dmp", "waveform.vcd", "probes.ltx"];

/// Creates an archive of the fixtures, with those in `but` replaced or, if empty, omitted.
pub fn archive_but(but: &[(&str, &[u8])]) -> Vec<u8> {
    packed("archive", but)
}

/// Creates such an archive of a System ILA: a port with named slices, words among numbers, and a view of other probes
/// that is not in the dump.
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
