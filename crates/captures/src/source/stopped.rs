//! A source that somebody else may stop.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tofsim::error::Result;

use super::signals::{Origin, Source};
use super::stream::Cursor;

/// Where changes come from, until it is stopped.
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
    /// The same, but reading it fails as interrupted once `stop` is set.
    pub fn stopped_by(self, stop: Arc<AtomicBool>) -> Source {
        let origin = Arc::new(Stopped { origin: Arc::clone(&self.origin), stop });
        Source { origin, ..self }
    }
}
