//! Sources of the peers, derived from `rtl_ref`: whatever is exchanged keeps the firmware's own module header, and with
//! it all ports and parameters.

use std::fs;
use std::path::Path;

use crate::Result;

/// Estimators that are never started, and whose clocks nobody is to pay for.
const IDLE: [&str; 2] = ["centroid_estimator", "likelihood_estimator"];

/// Variant of the Verilog sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sources {
    /// The sources in `rtl_ref`.
    Reference,
    /// The sources in `rtl_ref`, with the fastest coding of the decoder's ones count.
    FastDecoder,
}

/// A source file.
#[derive(Clone, Debug, Hash)]
pub struct Source {
    /// Its name, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
}

impl Source {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self> {
        let text =
            fs::read_to_string(path).map_err(|fault| format!("{}: {fault}", path.display()))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Source { name, text })
    }

    /// True if it is Verilog or SystemVerilog.
    pub fn is_verilog(&self) -> bool {
        [".v", ".sv"].iter().any(|ending| self.name.ends_with(ending))
    }
}

impl Sources {
    /// Returns the modules of the firmware, without the tops of the boards.
    ///
    /// # Errors
    /// A file that cannot be read, or a module whose header is not found.
    pub fn modules(self, root: &Path) -> Result<Vec<Source>> {
        let mut modules = Vec::new();
        for entry in fs::read_dir(root.join("rtl_ref"))? {
            let file = entry?.path();
            let block = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let is_board = block.ends_with("_top") && block != "tof_top";
            if file.extension().is_none_or(|ending| ending != "v") || is_board {
                continue;
            }
            let mut module = Source::read(&file)?;
            let body = if IDLE.contains(&&*block) {
                Some(idle(header(&module)?))
            } else if self == Sources::FastDecoder && block == "tdc_decoder" {
                let body = root.join("benches/peer_simulators/tdc_decoder_body.sv");
                Some(Source::read(&body)?.text)
            } else {
                None
            };
            if let Some(body) = body {
                let text = format!("{}{body}", header(&module)?);
                module = Source { name: format!("{block}.sv"), text };
            }
            modules.push(module);
        }
        modules.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(modules)
    }
}

/// Returns a module's text up to the end of its ports.
fn header(module: &Source) -> Result<&str> {
    let end = "\n);\n";
    let at = module.text.find(end).ok_or_else(|| format!("{}: no line );", module.name))?;
    Ok(&module.text[..at + end.len()])
}

/// Returns the body of a module whose outputs are always zero.
fn idle(header: &str) -> String {
    let output = |line: &str| {
        let declared = line.trim().strip_prefix("output ")?;
        let declared = declared.split("//").next()?.trim().trim_end_matches(',');
        let name = declared.rsplit(' ').next()?;
        let kind = if declared.starts_with("reg ") { "initial" } else { "assign" };
        Some(format!("    {kind} {name} = 0;\n"))
    };
    header.lines().filter_map(output).collect::<String>() + "endmodule\n"
}
