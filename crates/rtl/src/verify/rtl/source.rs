//! A source file of a design.

use std::path::{Path, PathBuf};

use tofsim::error::open::open_file;
use tofsim::error::{Error, Result, read_bytes};

use super::scan::Scan;
use super::search;

/// A source file.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its absolute path.
    pub path: PathBuf,
    /// Names that it declares and uses.
    pub scan: Scan,
    /// True if it was found in a folder: then it is compiled only where something in it is needed.
    pub found: bool,
}

impl Source {
    /// A file; `found` in a folder, or named.
    ///
    /// # Errors
    /// When it cannot be read, or is a pipe or a device, which a simulator could not read again.
    pub fn read(path: &Path, found: bool) -> Result<Self> {
        open_file(path)?;
        let path = path.canonicalize().map_err(Error::io(path, "read"))?;
        let bytes = read_bytes(&path)?;
        let text = String::from_utf8_lossy(&bytes);
        let mut source = Source { path, scan: Scan::default(), found };
        source.scan = if source.is_vhdl() { Scan::vhdl(&text) } else { Scan::verilog(&text) };
        Ok(source)
    }

    pub(super) fn is_vhdl(&self) -> bool {
        search::ends_in(&self.path, &["vhd", "vhdl"])
    }

    /// Returns whether it says by its name that it is SystemVerilog.
    pub fn is_system_verilog(&self) -> bool {
        search::ends_in(&self.path, &["sv"])
    }
}
