//! Cache of compiled peers, by a hash of their inputs.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use crate::sources::Source;
use crate::{Result, versions};

/// A folder of built peers.
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// Opens or creates the cache in `target`.
    pub fn new(target: &Path) -> Result<Self> {
        let folder = target.join("peers");
        fs::create_dir_all(&folder)?;
        Ok(Cache { folder })
    }

    /// Returns the folder with the output of `build` for these `sources` and `flags`, building it if necessary.
    /// `build` receives the folder to work in, which has the sources, and the paths of those that are Verilog.
    pub fn get(
        &self,
        name: &str,
        sources: &[Source],
        flags: &[&str],
        build: impl FnOnce(&Path, &[PathBuf]) -> Result<()>,
    ) -> Result<PathBuf> {
        let mut hasher = DefaultHasher::new();
        (sources, flags, versions::cpu(), versions::compilers()).hash(&mut hasher);
        let kept = self.folder.join(format!("{name}-{:016x}", hasher.finish()));
        if kept.is_dir() {
            return Ok(kept);
        }
        eprintln!("peers: building {name}");
        let work = self.folder.join(format!("{name}.building"));
        if work.exists() {
            fs::remove_dir_all(&work)?;
        }
        fs::create_dir_all(&work)?;
        let mut verilog = Vec::new();
        for source in sources {
            let path = work.join(&source.name);
            fs::write(&path, &source.text)?;
            if source.is_verilog() {
                verilog.push(path);
            }
        }
        build(&work, &verilog).map_err(|fault| format!("cannot build {name}: {fault}"))?;
        fs::rename(&work, &kept)?;
        Ok(kept)
    }
}
