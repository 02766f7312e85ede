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

/// The files of the archive, with those of `but` exchanged or, if empty, left out.
pub fn archive_but(but: &[(&str, &[u8])]) -> Vec<u8> {
    let names = ["waveform.csv", "waveform.dmp", "probes.ltx"];
    let entries = names.map(|name| {
        let other = but.iter().find(|(other, _)| *other == name);
        (name, other.map_or_else(|| bytes(&format!("archive/{name}")), |(_, bytes)| bytes.to_vec()))
    });
    let kept = entries.iter().filter(|(_, content)| !content.is_empty());
    let kept: Vec<_> = kept.map(|(name, content)| (*name, &content[..])).collect();
    archive(&kept)
}
