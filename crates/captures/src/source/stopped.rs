//! Sources that can be stopped from outside.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tofsim::error::Result;

use super::signals::{Origin, Source};
use super::stream::Cursor;

/// A source's implementation, with a flag that stops it.
#[derive(Debug)]
struct Stopped {
    origin: Arc<dyn Origin>,
    stop: Arc<AtomicBool>,
}

impl Origin for Stopped {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let mut cursor = self.origin.read(ids, widths)?;
        cursor.stop = Arc::clone(&self.stop);
        Ok(cursor)
    }

    fn searched(&self) -> Result<Option<u64>> {
        self.origin.searched()
    }
}

impl Source {
    /// Returns the source with a flag: once `stop` is set, reading fails as interrupted.
    pub fn stopped_by(self, stop: Arc<AtomicBool>) -> Source {
        let origin = Arc::new(Stopped { origin: Arc::clone(&self.origin), stop });
        Source { origin, ..self }
    }
}
