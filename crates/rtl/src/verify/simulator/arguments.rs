//! Arguments of the simulators, but for the sources.

use std::ffi::OsString;
use std::path::Path;

/// Options of a simulator for the sources.
#[derive(Clone, Copy, Debug)]
pub struct SourceOptions {
    /// Begin of the option for a suffix of files in library folders.
    pub suffix: &'static str,
    /// Option for a library file.
    pub library: &'static str,
    /// Options for Verilog-2005 and for SystemVerilog, where both are not read alike.
    pub languages: Option<[&'static str; 2]>,
}

/// Icarus's.
pub const ICARUS: SourceOptions =
    SourceOptions { suffix: "-Y", library: "-l", languages: Some(["-g2005", "-g2012"]) };
/// Verilator's.
pub const VERILATOR: SourceOptions =
    SourceOptions { suffix: "+libext+", library: "-v", languages: None };

/// Verilator's options for a program that runs for seconds: all in one file, as each of ten would include the same
/// headers, and optimised so far that it is as fast as with Verilator's own `-Os`.
pub const QUICK_TO_COMPILE: [&str; 4] =
    ["--output-split", "1000000", "-MAKEFLAGS", "OPT_FAST=-O1 OPT_SLOW=-O0"];

/// Icarus's arguments to compile `top` into a file.
pub fn icarus(top: &str, output: &Path) -> Vec<OsString> {
    let mut args = ["-grelative-include", "-s", top, "-o"].map(OsString::from).to_vec();
    args.push(output.into());
    args
}

/// Verilator's arguments to do something with `top`. It takes the first of two modules of one name, and warns only,
/// where Icarus refuses them.
pub fn verilator<'a>(
    action: &'a str,
    top: &'a str,
    more: impl IntoIterator<Item = &'a str>,
) -> Vec<OsString> {
    let args = [
        action,
        "--timing",
        "--relative-includes",
        "-Wno-fatal",
        "-Wno-lint",
        "-Wno-style",
        "-Werror-MODDUP",
        "--top-module",
        top,
    ];
    args.into_iter().chain(more).map(OsString::from).collect()
}
