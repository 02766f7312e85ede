//! GHW files, which the library can only load whole.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use wellen::viewers::HeaderResult;
use wellen::{LoadOptions, SignalRef};

use tofsim::error::{Error, Result};

use crate::words::Bits;

use super::counts::check;
use super::library::{fault, set};
use super::stream::Feed;

/// The head of the file.
pub(super) fn open(path: &Path) -> Result<HeaderResult<BufReader<File>>> {
    let mut file = File::open(path).map_err(Error::io(path, "read"))?;
    check(&path.display().to_string(), &mut file).map_err(Error::io(path, "read"))??;
    let options = LoadOptions { multi_thread: false, remove_scopes_with_empty_name: true };
    wellen::viewers::read_header(BufReader::new(file), &options).map_err(|error| fault(path, error))
}

/// Feeds the changes of `references`, in the order of time.
pub(super) fn feed(path: &Path, references: &[SignalRef], feed: &mut Feed) -> Result<()> {
    let header = open(path)?;
    let body = wellen::viewers::read_body(header.body, &header.hierarchy, None);
    let mut body = body.map_err(|error| fault(path, error))?;
    let mut wanted = references.to_vec();
    wanted.sort();
    wanted.dedup();
    let loaded = body.source.load_signals(&wanted, &header.hierarchy, false);
    let mut signals: Vec<_> = Vec::new();
    for (place, reference) in references.iter().enumerate() {
        let found = loaded.iter().find(|signal| signal.signal_ref() == *reference);
        signals.extend(found.map(|signal| (place, signal.iter_changes().peekable())));
    }
    let mut bits = Bits::default();
    for (index, &at) in body.time_table.iter().enumerate() {
        for (place, changes) in &mut signals {
            while let Some((_, value)) = changes.next_if(|(time, _)| *time as usize == index) {
                if feed.at(at).is_err() {
                    return Ok(());
                }
                set(&mut bits, value, feed.words(*place));
                feed.change(*place, &bits.value, &bits.unknown);
            }
        }
    }
    Ok(())
}
