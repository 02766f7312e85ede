//! Record of the last place-and-route of our own Verilog, so that it is repeated only for another netlist.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::output::write_bytes;

use super::estimate::Estimate;
use super::nextpnr::Measurement;

/// Results of all blocks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Versions of the tools.
    pub tools: BTreeMap<String, String>,
    /// Blocks by name.
    pub blocks: BTreeMap<String, BlockTiming>,
}

/// Result of a block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockTiming {
    /// Measured for an ECP5; none where that was not asked for, or cannot be.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub ecp5: Option<Measurement>,
    /// Estimated for a Kintex-7; none where that was not asked for.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub kintex7: Option<Estimate>,
}

impl Record {
    /// Reads the record of a file; returns `None` if there is no such file.
    ///
    /// # Errors
    /// When it cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Option<Self>> {
        if !path.exists() {
            return Ok(None);
        }
        let record = serde_json::from_str(&read_text(path)?);
        let fault = |error| {
            Input::new(path.display().to_string(), format!("expected a record of timing: {error}"))
        };
        Ok(Some(record.map_err(fault)?))
    }

    /// Writes it.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(|error| Error::Io {
            path: path.to_owned(),
            action: "write",
            source: error.into(),
        })?;
        write_bytes(path, text + "\n")
    }
}
