//! The design under test: source files of the user's, or our own, which are in the program.

pub mod file_list;
pub mod mirror;
mod order;
pub mod scan;
mod search;
mod source;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tofsim::error::{Error, Input, Result, hint};
use tofsim::files::output::write_bytes;

use crate::golden::blocks;

use file_list::Listed;
use order::Tree;
use scan::Scan;

pub use source::Source;

/// Places of the sources of a design.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Folders, which are searched with all below them, and files.
    pub paths: Vec<PathBuf>,
    /// File lists, and whether their paths are relative to the list.
    pub lists: Vec<(PathBuf, bool)>,
    /// Folders in which an `` `include `` is looked for.
    pub includes: Vec<PathBuf>,
    /// Macros: `NAME` or `NAME=VALUE`.
    pub defines: Vec<String>,
}

/// The sources of a design.
#[derive(Clone, Debug, Default)]
pub struct Rtl {
    /// Verilog and SystemVerilog, in the order in which they are named; those of a folder are sorted.
    pub files: Vec<Source>,
    /// VHDL.
    pub vhdl: Vec<Source>,
    /// Folders of includes and libraries, macros, and what was passed over.
    pub options: Listed,
    /// Their origin, for people.
    pub source: String,
    /// Length of all of them [bytes].
    length: u64,
}

/// Most that sources may have in all [bytes].
const LONGEST: u64 = 1 << 29;

impl Rtl {
    /// The sources of a folder and all below it.
    ///
    /// # Errors
    /// As [`Rtl::read`].
    pub fn folder(folder: &Path) -> Result<Self> {
        Self::read(&Sources { paths: vec![folder.to_owned()], ..Sources::default() })
    }

    /// Reads the sources that are named, each file once.
    ///
    /// # Errors
    /// When a file, folder or list cannot be read, or there is no source among them.
    pub fn read(sources: &Sources) -> Result<Self> {
        let names: Vec<_> =
            (sources.paths.iter().chain(sources.lists.iter().map(|(list, _)| list)))
                .map(|path| path.display().to_string())
                .collect();
        let mut rtl = Rtl { source: names.join(", "), ..Rtl::default() };
        let options = &mut rtl.options;
        for (list, is_base) in &sources.lists {
            options.read(list, *is_base)?;
        }
        let listed = std::mem::take(&mut options.files);
        options.includes.splice(0..0, sources.includes.iter().cloned());
        options.defines.extend(sources.defines.iter().cloned());
        for folder in options.includes.iter_mut().chain(&mut options.libraries) {
            *folder = folder.canonicalize().map_err(Error::io(folder.as_path(), "read"))?;
            if !folder.is_dir() {
                let folder = folder.display().to_string();
                return Err(Input::new("-I", "expected a folder").value(folder).into());
            }
        }
        for file in &mut options.library_files {
            *file = file.canonicalize().map_err(Error::io(file.as_path(), "read"))?;
        }
        for path in listed {
            rtl.add(&path, false)?;
        }
        for path in &sources.paths {
            if path.is_dir() {
                for file in search::sources(path)? {
                    rtl.add(&file, true)?;
                }
            } else {
                rtl.add(path, false)?;
            }
        }
        if rtl.files.is_empty() && rtl.vhdl.is_empty() && rtl.options.library_files.is_empty() {
            let expected = "no .v, .sv, .vhd or .vhdl file in it";
            return Err(Input::new("--rtl", expected).value(&rtl.source).into());
        }
        Ok(rtl)
    }

    fn add(&mut self, path: &Path, found: bool) -> Result<()> {
        self.length += path.metadata().map_err(Error::io(path, "read"))?.len();
        if self.length > LONGEST {
            let expected = format!("expected sources of {} MiB at most in all", LONGEST >> 20);
            return Err(Input::new(&self.source, expected).value(path.display()).into());
        }
        let source = Source::read(path, found)?;
        let files = if source.is_vhdl() { &mut self.vhdl } else { &mut self.files };
        if !files.iter().any(|file| file.path == source.path) {
            files.push(source);
        }
        Ok(())
    }

    /// Returns whether one of the files declares that module, or that entity, whatever the case of its
    /// letters.
    pub fn has(&self, module: &str) -> bool {
        let declares = |source: &Source| source.scan.modules.iter().any(|it| it.name == module);
        let in_library = |folder: &PathBuf| {
            self.suffixes().iter().any(|end| folder.join(format!("{module}{end}")).is_file())
        };
        self.files.iter().any(declares)
            || self.has_entity(module)
            || self.options.libraries.iter().any(in_library)
    }

    /// Returns whether a VHDL file declares that entity, and no Verilog file a module of that name.
    pub fn has_entity(&self, name: &str) -> bool {
        let lower = name.to_lowercase();
        let is_named =
            |source: &Source, name: &str| source.scan.modules.iter().any(|it| it.name == name);
        self.vhdl.iter().any(|source| is_named(source, &lower))
            && !self.files.iter().any(|source| is_named(source, name))
    }

    /// Selects, of some names, those that the files of an entity have, as its generics have to be.
    pub fn generics<'a>(
        &self,
        entity: &str,
        names: impl Iterator<Item = &'a str>,
    ) -> BTreeSet<String> {
        let entity = entity.to_lowercase();
        let declares = |source: &&Source| source.scan.modules.iter().any(|it| it.name == entity);
        let files: Vec<_> = self.vhdl.iter().filter(declares).collect();
        let is_in = |name: &str| {
            files.iter().any(|source| source.scan.words.contains(&name.to_lowercase()))
        };
        names.filter(|name| is_in(name)).map(str::to_owned).collect()
    }

    /// Suffixes of the files in library folders.
    pub fn suffixes(&self) -> Vec<&str> {
        match self.options.suffixes.as_slice() {
            [] => vec![".v", ".sv"],
            suffixes => suffixes.iter().map(String::as_str).collect(),
        }
    }

    /// The Verilog files that something which names those identifiers needs, packages before their users:
    /// all that were named one by one, and of those found in folders the ones that declare what is needed
    /// and the ones that declare no module at all.
    ///
    /// # Errors
    /// When two files declare the same module, or packages need each other.
    pub fn needed(&self, text: &str) -> Result<Vec<&Source>> {
        let (name, files, includes) = (&self.source, &self.files, &self.options.includes);
        Tree { name, files, includes }.needed(&Scan::verilog(text).words)
    }

    /// Returns those files and the ones that they include, and the files of libraries.
    pub fn with_included(&self, files: &[&Source]) -> BTreeSet<PathBuf> {
        let (name, includes) = (&self.source, &self.options.includes);
        let tree = Tree { name, files: &self.files, includes };
        let own = files.iter().map(|file| file.path.clone());
        own.chain(tree.included(files)).chain(self.options.library_files.iter().cloned()).collect()
    }

    /// Names of the modules and entities that the files declare, sorted.
    pub fn modules(&self) -> BTreeSet<&str> {
        let sources = self.files.iter().chain(&self.vhdl);
        sources.flat_map(|source| &source.scan.modules).map(|it| it.name.as_str()).collect()
    }

    /// Explains that there is no such module: which name is most like it, and which there are.
    pub fn lacks(&self, module: &str) -> String {
        let (hint, names) = hint(module, self.modules());
        if names.is_empty() {
            format!("no such module{hint}; the files declare none")
        } else {
            format!("no such module{hint}; the files declare {names}")
        }
    }

    /// Our own, written into `folder`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn own(folder: &Path) -> Result<Self> {
        let mut rtl = Rtl { source: "rtl_ref".to_owned(), ..Rtl::default() };
        for (name, text) in blocks::verilog() {
            let path = folder.join(name);
            write_bytes(&path, text)?;
            rtl.add(&path, true)?;
        }
        Ok(rtl)
    }
}
