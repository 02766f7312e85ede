//! The Verilog under test: a folder of the user's, or our own, which is in the program.

use std::fs;
use std::path::{Path, PathBuf};

use tofsim::error::{Error, Input, Result};
use tofsim::files::output::write_bytes;

use crate::golden::blocks::VERILOG;

/// Verilog source files.
#[derive(Clone, Debug)]
pub struct Rtl {
    /// Their absolute paths, sorted.
    pub files: Vec<PathBuf>,
    /// Where they come from, for people.
    pub source: String,
}

impl Rtl {
    /// The `.v` and `.sv` files of a folder.
    ///
    /// # Errors
    /// When the folder cannot be read or has none.
    pub fn folder(folder: &Path) -> Result<Self> {
        let fault = || Error::io(folder, "read");
        let mut files = Vec::new();
        for entry in fs::read_dir(folder).map_err(fault())? {
            let path = entry.map_err(fault())?.path();
            let verilog = path.extension().is_some_and(|end| end == "v" || end == "sv");
            if verilog && path.is_file() {
                files.push(path.canonicalize().map_err(fault())?);
            }
        }
        files.sort();
        let source = folder.display().to_string();
        if files.is_empty() {
            return Err(Input::new("--rtl", "no .v or .sv file in it").value(source).into());
        }
        Ok(Rtl { files, source })
    }

    /// Whether a file says by its name that it is SystemVerilog.
    pub fn is_system_verilog(&self) -> bool {
        self.files.iter().any(|file| file.extension().is_some_and(|end| end == "sv"))
    }

    /// Whether one of the files declares that module.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn has(&self, module: &str) -> Result<bool> {
        for file in &self.files {
            let bytes = fs::read(file).map_err(Error::io(file, "read"))?;
            let text = String::from_utf8_lossy(&bytes);
            let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '$'));
            while words.by_ref().any(|word| word == "module") {
                if words.find(|word| !word.is_empty()) == Some(module) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Our own, written into `folder`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn own(folder: &Path) -> Result<Self> {
        let mut files = Vec::new();
        for (name, text) in VERILOG {
            let path = folder.join(name);
            write_bytes(&path, text)?;
            files.push(path);
        }
        Ok(Rtl { files, source: "rtl_ref".to_owned() })
    }
}
