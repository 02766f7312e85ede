//! The options that name the sources of a design.

use std::path::PathBuf;

use tofsim::error::{Input, Result};
use tofsim_rtl::verify::rtl::Sources;
use tofsim_rtl::verify::{Rtl, yosys};

use super::terminal::Console;

/// The sources of the design.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("sources").multiple(true))]
pub struct Design {
    /// Folder with the design (all .v, .sv, .vhd and .vhdl files in it and below), or one file; may be
    /// repeated
    #[arg(long, value_name = "PATH", group = "sources")]
    rtl: Vec<PathBuf>,
    /// File list, as simulators take them; its paths are relative to the current folder; may be repeated
    #[arg(short = 'f', long = "file-list", value_name = "FILE", group = "sources")]
    list: Vec<PathBuf>,
    /// File list whose paths are relative to itself; may be repeated
    #[arg(short = 'F', long = "relative-file-list", value_name = "FILE", group = "sources")]
    relative_list: Vec<PathBuf>,
    /// Folder to search for `include files, after that of the including file; may be repeated
    #[arg(short = 'I', long = "include", value_name = "DIR", requires = "sources")]
    include: Vec<PathBuf>,
    /// Define a macro; may be repeated
    #[arg(short = 'D', long = "define", value_name = "NAME[=VALUE]", requires = "sources")]
    define: Vec<String>,
}

impl Design {
    /// Whether none is named: then it is our own.
    pub fn is_ours(&self) -> bool {
        self.rtl.is_empty() && self.list.is_empty() && self.relative_list.is_empty()
    }

    /// Checks that Yosys can read a design; the error names `source`.
    ///
    /// # Errors
    /// When it has a source or a library that is no Verilog.
    pub fn check_for_yosys(rtl: &Rtl, source: &str) -> Result<()> {
        let Some(path) = yosys::unread(rtl) else { return Ok(()) };
        let expected =
            "expected Verilog sources only, without libraries: Yosys reads no others here";
        Err(Input::new(source, expected).value(path.display()).into())
    }

    /// The design; what its lists have beside sources is noted.
    ///
    /// # Errors
    /// When a source cannot be read, or there is none.
    pub fn read(&self, console: &Console) -> Result<Rtl> {
        let lists = self.list.iter().map(|list| (list.clone(), false));
        let relative = self.relative_list.iter().map(|list| (list.clone(), true));
        let rtl = Rtl::read(&Sources {
            paths: self.rtl.clone(),
            lists: lists.chain(relative).collect(),
            includes: self.include.clone(),
            defines: self.define.clone(),
        })?;
        for option in &rtl.options.unknown {
            console.note(format_args!("{option}: no option of a source, which is passed over"));
        }
        Ok(rtl)
    }
}

/// Returns what a design has of some blocks; a note names those that it lacks, which are not `done`.
///
/// # Errors
/// When it has none of them.
pub fn present<'a, T>(
    all: impl Iterator<Item = &'a T>,
    has: impl Fn(&T) -> bool,
    name: fn(&T) -> &str,
    (rtl, or, done): (&Rtl, &str, &str),
    console: &Console,
) -> Result<Vec<&'a T>> {
    let (there, missing): (Vec<_>, Vec<_>) = all.partition(|block| has(block));
    let missing: Vec<_> = missing.into_iter().map(name).collect();
    let (source, missing) = (&rtl.source, missing.join(", "));
    if there.is_empty() {
        let declared = match rtl.modules().into_iter().collect::<Vec<_>>().join(", ") {
            names if names.is_empty() => "none".to_owned(),
            names => names,
        };
        let expected =
            format!("expected one of the modules {missing}{or}; the files declare {declared}");
        return Err(Input::new(source, expected).into());
    }
    if !missing.is_empty() {
        console
            .note(format_args!("{source}: not {done}, because it has no such module: {missing}"));
    }
    Ok(there)
}
