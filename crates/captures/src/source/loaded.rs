//! GHW files, which the library can only load as a whole.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::io::Cursor;
use std::path::Path;

use wellen::viewers::HeaderResult;
use wellen::{LoadOptions, SignalRef};

use tofsim::error::{Error, Result};

use crate::words::Bits;

use super::ghw;
use super::library::{fault, set};
use super::stream::Feed;

/// Reads the header of a file.
pub(super) fn open(path: &Path) -> Result<HeaderResult<Cursor<Vec<u8>>>> {
    let bytes = std::fs::read(path).map_err(Error::io(path, "read"))?;
    ghw::check(&bytes).map_err(|fault| fault.of_file(path))?;
    let options = LoadOptions { multi_thread: false, remove_scopes_with_empty_name: true };
    wellen::viewers::read_header(Cursor::new(bytes), &options).map_err(|error| fault(path, error))
}

/// Sends the changes of `references`, in order of time.
pub(super) fn feed(path: &Path, references: &[SignalRef], feed: &mut Feed) -> Result<()> {
    let header = open(path)?;
    let body = wellen::viewers::read_body(header.body, &header.hierarchy, None);
    let mut body = body.map_err(|error| fault(path, error))?;
    let mut wanted = references.to_vec();
    wanted.sort();
    wanted.dedup();
    let loaded = body.source.load_signals(&wanted, &header.hierarchy, false);
    let loaded: HashMap<_, _> = loaded.iter().map(|signal| (signal.signal_ref(), signal)).collect();
    let mut changes: Vec<_> =
        references.iter().map(|reference| Some(loaded.get(reference)?.iter_changes())).collect();
    let mut next = |place: usize| changes[place].as_mut()?.next();
    let mut waiting: BinaryHeap<Reverse<(u32, usize)>> = BinaryHeap::new();
    let mut values: Vec<_> = Vec::new();
    for place in 0..references.len() {
        let first = next(place);
        waiting.extend(first.map(|(time, _)| Reverse((time, place))));
        values.push(first.map(|(_, value)| value));
    }
    let mut bits = Bits::default();
    while let Some(Reverse((time, place))) = waiting.pop() {
        let Some(&at) = body.time_table.get(time as usize) else { break };
        let Some(value) = values[place].take() else { continue };
        if feed.at(at).is_err() {
            return Ok(());
        }
        set(&mut bits, value, feed.words(place));
        feed.change(place, &bits.value, &bits.unknown);
        if let Some((time, value)) = next(place) {
            values[place] = Some(value);
            waiting.push(Reverse((time, place)));
        }
    }
    Ok(())
}
