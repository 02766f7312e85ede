//! What a simulator compiles: the files of a design that a top module needs.

use std::ffi::OsString;
use std::path::Path;

use tofsim::error::Result;

use crate::verify::process::Limits;
use crate::verify::rtl::mirror::Mirror;
use crate::verify::rtl::{Rtl, Source};

use super::arguments::SourceOptions;
use super::refusal;

/// A compilation of a design, by whichever simulator.
pub struct Job<'a> {
    /// The folder that it runs in.
    pub folder: &'a Path,
    /// The top module.
    pub top: &'a str,
    /// The design.
    pub rtl: &'a Rtl,
    /// When to give up.
    pub limits: &'a Limits<'a>,
    /// Arguments before the design's files, the same for every simulator.
    pub first: Vec<OsString>,
    needed: Vec<&'a Source>,
    mirror: Option<Mirror>,
}

impl<'a> Job<'a> {
    /// A compilation of what `text` needs of a design.
    ///
    /// # Errors
    /// When the design has nothing that it needs, or a file cannot be read.
    pub fn new(
        folder: &'a Path,
        top: &'a str,
        text: &str,
        rtl: &'a Rtl,
        limits: &'a Limits<'a>,
    ) -> Result<Self> {
        let needed = rtl.needed(text)?;
        let options = &rtl.options;
        if needed.is_empty() && options.libraries.is_empty() && options.library_files.is_empty() {
            return Err(refusal::no_module(rtl, top).into());
        }
        let mirror = Mirror::of(&rtl.with_included(&needed), &folder.join("unmarked"))?;
        Ok(Job { folder, top, rtl, limits, first: Vec::new(), needed, mirror })
    }

    /// Returns whether it is SystemVerilog, by the name of a file or an option of a list.
    pub fn is_system_verilog(&self) -> bool {
        self.rtl.options.system_verilog
            || self.needed.iter().any(|source| source.is_system_verilog())
    }

    /// Arguments that give a simulator the files.
    pub fn arguments(&self, known: &SourceOptions, is_system_verilog: bool) -> Vec<OsString> {
        let options = &self.rtl.options;
        let joined = |option: &str, value: OsString| {
            let mut word = OsString::from(option);
            word.push(value);
            word
        };
        let mut args = self.first.clone();
        args.extend(known.languages.map(|both| both[usize::from(is_system_verilog)].into()));
        let copies = self
            .mirror
            .iter()
            .flat_map(|mirror| options.includes.iter().map(|folder| mirror.path(folder)));
        args.extend(copies.map(|folder| joined("-I", folder.into())));
        args.extend(options.includes.iter().map(|folder| joined("-I", folder.into())));
        args.extend(options.defines.iter().map(|define| joined("-D", define.into())));
        for folder in &options.libraries {
            args.extend(["-y".into(), folder.into()]);
        }
        if !options.libraries.is_empty() {
            args.extend(self.rtl.suffixes().iter().map(|end| joined(known.suffix, end.into())));
        }
        for file in &options.library_files {
            args.extend([known.library.into(), self.place(file)]);
        }
        args.extend(self.needed.iter().map(|source| self.place(&source.path)));
        args
    }

    /// A file, or its copy.
    fn place(&self, file: &Path) -> OsString {
        self.mirror.as_ref().map_or(file.into(), |mirror| mirror.path(file).into())
    }

    /// A simulator's message, with the files in place of their copies.
    pub fn with_originals(&self, message: &str) -> String {
        self.mirror.as_ref().map_or(message.to_owned(), |mirror| mirror.with_originals(message))
    }
}
