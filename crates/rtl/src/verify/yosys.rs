//! Arguments that give Yosys the sources of a design.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result};

use super::process::{Limits, YOSYS};
use super::rtl::Rtl;

/// Its arguments for those sources that something which names the identifiers of `text` needs, with one more
/// macro, and with paths relative to `folder` where they are in it.
///
/// # Errors
/// As [`Rtl::needed`].
pub fn sources(
    rtl: &Rtl,
    text: &str,
    folder: &Path,
    define: Option<&str>,
) -> Result<Vec<OsString>> {
    let needed = rtl.needed(text)?;
    let is_system_verilog =
        rtl.options.system_verilog || needed.iter().any(|source| source.is_system_verilog());
    let frontend = if is_system_verilog { "verilog -defer -sv" } else { "verilog -defer" };
    let folders = rtl.options.includes.iter().map(|folder| format!(" -I{}", folder.display()));
    let defines = rtl.options.defines.iter().map(String::as_str).chain(define);
    let defines = defines.map(|define| format!(" -D{define}"));
    let frontend: String =
        [frontend.to_owned()].into_iter().chain(folders).chain(defines).collect();
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let relative = |path: &Path| path.strip_prefix(&folder).unwrap_or(path).into();
    let files = needed.iter().map(|source| relative(&source.path));
    Ok(["-f".into(), frontend.into()].into_iter().chain(files).collect())
}

/// Runs a script over those sources, and more files, so that it leaves a netlist; errors name `field`.
///
/// # Errors
/// When Yosys is missing, refuses the sources, or does not end.
pub fn synthesise(
    (rtl, field): (&Rtl, &str),
    folder: &Path,
    sources: impl IntoIterator<Item = OsString>,
    script: String,
    limits: &Limits,
) -> Result<()> {
    let script = ["-p".into(), script.into()];
    let args = [OsString::from("-q")].into_iter().chain(sources).chain(script);
    let finished = YOSYS.run(folder, args, limits)?;
    if finished.success() {
        return Ok(());
    }
    let why = match finished.end.killed() {
        None => finished.error().unwrap_or("Yosys ended without a netlist").to_owned(),
        Some(why) => format!("Yosys {why}"),
    };
    Err(Input::new(&rtl.source, why).field(field).into())
}

/// A source of the design that Yosys does not read here, if there is one: VHDL, or a library's.
pub fn unread(rtl: &Rtl) -> Option<&PathBuf> {
    let vhdl = rtl.vhdl.first().map(|file| &file.path);
    vhdl.or(rtl.options.library_files.first()).or(rtl.options.libraries.first())
}
