//! Finds the sources of a folder.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tofsim::error::{Error, Result};

/// Returns whether a path has one of these suffixes, in upper or lower case.
pub fn ends_in(path: &Path, ends: &[&str]) -> bool {
    path.extension().is_some_and(|end| ends.iter().any(|it| end.eq_ignore_ascii_case(it)))
}

/// The Verilog and VHDL files of a folder and of those below it, sorted; hidden ones are left out.
///
/// # Errors
/// When a folder cannot be read.
pub fn sources(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = BTreeSet::new();
    // Links may lead round in a circle.
    let mut seen = BTreeSet::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let fault = || Error::io(&folder, "read");
        if !seen.insert(folder.canonicalize().map_err(fault())?) {
            continue;
        }
        for entry in std::fs::read_dir(&folder).map_err(fault())? {
            let entry = entry.map_err(fault())?;
            let path = entry.path();
            if entry.file_name().as_encoded_bytes().starts_with(b".") {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if ends_in(&path, &["v", "sv", "vhd", "vhdl"]) && path.is_file() {
                files.insert(path);
            }
        }
    }
    Ok(files.into_iter().collect())
}
