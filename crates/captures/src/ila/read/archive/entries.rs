//! Entries of an archive, including one that is truncated or lies within another zip.

use std::fs::File;
use std::io::{Cursor, Read, Seek};

use zip::ZipArchive;
use zip::read::read_zipfile_from_stream;

use tofsim::error::{Error, Input, Result};

use super::super::opened::damaged;

/// Size limit of an entry [bytes].
pub(super) const LARGEST_ENTRY: u64 = 1 << 30;

/// A seekable source of bytes.
trait Bytes: Read + Seek + Send {}

impl<T: Read + Seek + Send> Bytes for T {}

/// Reader of an archive.
pub(super) struct Entries {
    pub(super) source: String,
    /// Names of the entries.
    names: Vec<String>,
    content: Content,
}

enum Content {
    Whole(ZipArchive<Box<dyn Bytes>>),
    /// A truncated archive without the directory at its end.
    Cut(Box<dyn Bytes>),
}

impl Entries {
    /// Opens the archive in a file, with notes.
    pub(super) fn open(source: String, file: File) -> Result<(Self, Vec<String>)> {
        let (mut entries, mut notes) = Entries::of(source, Box::new(file))?;
        if entries.names.iter().any(|name| last(name).starts_with("waveform.")) {
            return Ok((entries, notes));
        }
        let is_inner = |name: &&String| name.to_ascii_lowercase().ends_with(".ila");
        let inner: Vec<_> = entries.names.iter().filter(is_inner).cloned().collect();
        match &inner[..] {
            [] => Ok((entries, notes)),
            [name] => {
                let read = |_: &str, entry: &mut dyn Read| whole("", entry, LARGEST_ENTRY);
                let bytes = entries.part(last(name), read).transpose()?.unwrap_or_default();
                let source = format!("{}/{name}", entries.source);
                let (inside, more) = Entries::of(source, Box::new(Cursor::new(bytes)))?;
                notes.push(format!("the capture is {name}, an archive inside this one"));
                notes.extend(more);
                Ok((inside, notes))
            }
            several => {
                let expected = "expected one archive inside; unpack the one that is meant";
                Err(Input::new(&entries.source, expected).value(several.join(", ")).into())
            }
        }
    }

    fn of(source: String, mut file: Box<dyn Bytes>) -> Result<(Self, Vec<String>)> {
        let fault = |error: zip::result::ZipError| {
            Input::new(&source, format!("expected a whole ZIP archive: {error}"))
        };
        // The library takes the file, and does not give it back with an error.
        if let Err(error) = ZipArchive::new(&mut file) {
            let io = |error| Error::from(fault(zip::result::ZipError::Io(error)));
            file.rewind().map_err(io)?;
            let mut names = Vec::new();
            while let Ok(Some(entry)) = read_zipfile_from_stream(&mut file) {
                names.push(String::from_utf8_lossy(entry.name_raw()).into_owned());
            }
            if names.is_empty() {
                return Err(fault(error).into());
            }
            let notes = vec![format!("the archive is cut off or damaged: {error}")];
            return Ok((Entries { source, names, content: Content::Cut(file) }, notes));
        }
        let zip = ZipArchive::new(file).map_err(fault)?;
        let names = zip.file_names_raw();
        let names = names.map(|name| String::from_utf8_lossy(name).into_owned()).collect();
        Ok((Entries { source, names, content: Content::Whole(zip) }, Vec::new()))
    }

    /// Reads the entry of this name in any directory; returns `None` if there is none.
    pub(super) fn part<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&str, &mut dyn Read) -> Result<T>,
    ) -> Option<Result<T>> {
        let index = self.names.iter().position(|path| last(path) == name)?;
        let source = format!("{}/{}", self.source, self.names[index]);
        let fault = |error: &dyn std::fmt::Display| {
            Error::from(Input::new(&source, format!("damaged: {error}")))
        };
        Some(match &mut self.content {
            Content::Whole(zip) => match zip.by_index(index) {
                Ok(mut entry) => read(&source, &mut entry),
                Err(error) => Err(fault(&error)),
            },
            Content::Cut(file) => {
                if let Err(error) = file.rewind() {
                    return Some(Err(fault(&error)));
                }
                for _ in 0..index {
                    let _skipped = read_zipfile_from_stream(file);
                }
                match read_zipfile_from_stream(file) {
                    Ok(Some(mut entry)) => read(&source, &mut entry),
                    Ok(None) => Err(fault(&"it is cut off")),
                    Err(error) => Err(fault(&error)),
                }
            }
        })
    }
}

/// Returns the last part of a path.
fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Reads an entry of limited size, regardless of the size that the archive states.
pub(super) fn whole(source: &str, entry: &mut dyn Read, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    entry.take(limit + 1).read_to_end(&mut bytes).map_err(|error| damaged(source, error))?;
    if bytes.len() as u64 > limit {
        Err(Input::new(source, format!("unpacks to more than {limit} bytes")).into())
    } else {
        Ok(bytes)
    }
}

/// Reads an entry of limited size as text.
pub(super) fn text(source: &str, entry: &mut dyn Read, limit: u64) -> Result<String> {
    let bytes = whole(source, entry, limit)?;
    String::from_utf8(bytes).map_err(|_| Input::new(source, "expected UTF-8 text").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_ends_in_an_error_at_its_limit() {
        let limited =
            |limit| whole("a.ila/x", &mut &b"12345"[..], limit).map_err(|error| error.to_string());
        assert_eq!(limited(5), Ok(b"12345".to_vec()));
        assert_eq!(limited(4), Err("a.ila/x: unpacks to more than 4 bytes".into()));
    }
}
