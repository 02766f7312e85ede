//! Detection of a file's format by its contents.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Error, Input, Result};

use crate::ila::Radix;

use super::signals::{Source, SourceFormat};
use super::{capture, fst, ghw, wave};

/// First bytes of a zip archive, such as an `.ila` file.
const ARCHIVE: &[u8] = b"PK";
/// First bytes of a GHW file.
const GHW: &[u8] = b"GHDLwave";
/// First words of a logic analyser's CSV.
const CSV: &[u8] = b"Sample in Buffer";
/// Number of bytes that are examined.
const HEAD: u64 = 4096;

/// Opens the source at `path`, until `stop` is set.
pub(super) fn open(path: &Path, radix: Option<Radix>, stop: &AtomicBool) -> Result<Source> {
    let found = std::fs::metadata(path).map_err(Error::io(path, "read"))?;
    if !found.is_file() {
        let expected = "expected a file, because it is read more than once";
        return Err(Input::new(path.display(), expected).into());
    }
    let mut head = Vec::new();
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    file.take(HEAD).read_to_end(&mut head).map_err(Error::io(path, "read"))?;
    let text = head.trim_ascii_start();
    if text.is_empty() {
        return Err(Input::new(path.display(), "is empty").into());
    }
    if head.starts_with(ARCHIVE) || starts_as_csv(text) {
        return capture::source(path, radix, stop);
    }
    let format = match head[0] {
        _ if text.starts_with(b"$") => SourceFormat::Vcd,
        _ if head.starts_with(GHW) => return ghw::source(path),
        fst::HEADER | fst::WRAPPED => SourceFormat::Fst,
        _ => {
            let expected =
                "expected VCD, FST, GHW, or an ILA's CSV (`Sample in Buffer,...`) or archive";
            let line: String = String::from_utf8_lossy(text).lines().next().unwrap_or("").into();
            return Err(Input::new(path.display(), expected).at(1, 1).value(line).into());
        }
    };
    wave::source(path, format, stop)
}

fn starts_as_csv(text: &[u8]) -> bool {
    let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
    let text = text.strip_prefix(b"\"").unwrap_or(text);
    text.get(..CSV.len()).is_some_and(|head| head.eq_ignore_ascii_case(CSV))
}
