//! Helpers of the tests of the logic analyser's files.
#![allow(dead_code, reason = "each test file uses a part of it")]

pub mod fixtures;

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;

use tofsim::error::Result;
use tofsim_captures::ila::Radix;
use tofsim_captures::ila::read::{CaptureRow, Opened, open};

/// Opens a file and reads all its rows.
pub fn read(path: &Path, radix: Option<Radix>) -> Result<(Opened, Vec<CaptureRow>)> {
    let mut opened = open(path, radix, None)?;
    let (mut rows, mut row) = (Vec::new(), CaptureRow::default());
    while opened.rows.next(&mut row)? {
        rows.push(row.clone());
    }
    Ok((opened, rows))
}

/// Opens bytes as a file named `capture` and reads all its rows; errors omit the temporary directory.
pub fn read_bytes(
    bytes: &[u8],
    radix: Option<Radix>,
) -> std::result::Result<(Opened, Vec<CaptureRow>), String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("capture");
    fs::write(&path, bytes).unwrap();
    let place = format!("{}/", directory.path().display());
    read(&path, radix).map_err(|error| error.to_string().replace(&place, ""))
}

/// Creates an archive of the given entries.
pub fn archive(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap().into_inner()
}
