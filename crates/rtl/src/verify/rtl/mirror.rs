//! Copies of sources that begin with a byte order mark, which Icarus Verilog and GHDL do not take.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use tofsim::error::{Result, read_bytes};
use tofsim::files::output::{create_directory, write_bytes};

/// What editors of Windows write before a text in UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// A folder with copies of files without their marks, each below it at the place that the file has.
#[derive(Clone, Debug)]
pub struct Mirror {
    folder: PathBuf,
}

impl Mirror {
    /// Copies files below `folder` if one of them begins with a mark.
    ///
    /// # Errors
    /// When one cannot be read, or copied.
    pub fn of(files: &BTreeSet<PathBuf>, folder: &Path) -> Result<Option<Mirror>> {
        let mut texts = Vec::new();
        let mut is_marked = false;
        for path in files {
            let text = read_bytes(path)?;
            is_marked |= text.starts_with(MARK);
            texts.push((path, text));
        }
        if !is_marked {
            return Ok(None);
        }
        let mirror = Mirror { folder: folder.to_owned() };
        for (path, text) in texts {
            let copy = mirror.path(path);
            create_directory(copy.parent().unwrap_or(folder))?;
            write_bytes(&copy, unmarked(&text))?;
        }
        Ok(Some(mirror))
    }

    /// The place of the copy of a file or folder.
    pub fn path(&self, original: &Path) -> PathBuf {
        let names = original.components().filter(|part| matches!(part, Component::Normal(_)));
        self.folder.join(names.collect::<PathBuf>())
    }

    /// A tool's message, with the files in place of their copies.
    pub fn with_originals(&self, message: &str) -> String {
        message.replace(&self.folder.display().to_string(), "")
    }
}

/// A text without its byte order mark.
pub fn unmarked(text: &[u8]) -> &[u8] {
    text.strip_prefix(MARK).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn files_are_copied_only_if_one_has_a_mark_and_messages_name_them() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a.v", "sub/b.v"].map(|name| folder.path().join(name));
        fs::create_dir(folder.path().join("sub")).unwrap();
        files.iter().for_each(|path| fs::write(path, "module").unwrap());
        let (set, copies) = (files.clone().into(), folder.path().join("copies"));
        assert!(Mirror::of(&set, &copies).unwrap().is_none());
        fs::write(&files[1], "\u{feff}module").unwrap();
        let mirror = Mirror::of(&set, &copies).unwrap().unwrap();
        for path in &files {
            let copy = mirror.path(path);
            assert_eq!(fs::read_to_string(&copy).unwrap(), "module");
            let message = mirror.with_originals(&format!("{}:1: error", copy.display()));
            assert_eq!(message, format!("{}:1: error", path.display()));
        }
    }
}
