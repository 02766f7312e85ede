//! Stream of changes from a reading thread to the comparison, in blocks.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use tofsim::error::{Result, poll_stop};

use super::guard::guarded;
use super::state::SourceState;

/// Size at which a block is sent [words].
const BLOCK: usize = 1 << 15;
/// Largest number of blocks in transit.
const DEPTH: usize = 4;
/// Interval at which the stop flag is checked while waiting for a block.
const LOOK: Duration = Duration::from_millis(50);

/// A logic analyser's marks of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// A window begins with it.
    pub window: bool,
    /// The sample triggered.
    pub trigger: bool,
    /// Samples are missing here.
    pub gap: bool,
}

/// Changes at one place.
#[derive(Clone, Copy, Debug)]
struct Instant {
    at: u64,
    marks: Marks,
    /// Index after its last change.
    end: usize,
}

#[derive(Debug, Default)]
struct Block {
    instants: Vec<Instant>,
    /// Signals that change.
    changes: Vec<u32>,
    /// For each change, the words of its value followed by those of its unknown bits.
    words: Vec<u64>,
}

/// Sending end of the stream, used by the reading thread.
pub struct Feed {
    blocks: SyncSender<Result<Block>>,
    block: Block,
    words: Vec<usize>,
    at: Option<(u64, Marks)>,
}

/// Indication that the receiving end has been dropped, so that reading should stop.
#[derive(Clone, Copy, Debug)]
pub struct Disconnected;

impl Feed {
    /// Sets the place of the changes that follow, which must not decrease.
    ///
    /// # Errors
    /// If the receiving end has been dropped.
    #[inline]
    pub fn at(&mut self, at: u64) -> std::result::Result<(), Disconnected> {
        if self.at.is_some_and(|(now, _)| now == at) {
            return Ok(());
        }
        self.end()?;
        self.at = Some((at, Marks::default()));
        Ok(())
    }

    /// Changes the marks of the present place.
    pub fn mark(&mut self, change: impl FnOnce(&mut Marks)) {
        if let Some((_, marks)) = &mut self.at {
            change(marks);
        }
    }

    /// Adds a change of a signal to `value`, with `unknown` bits; both have the number of words of its width.
    #[inline]
    pub fn change(&mut self, signal: usize, value: &[u64], unknown: &[u64]) {
        debug_assert!(value.len() == self.words[signal] && unknown.len() == value.len());
        self.block.changes.push(signal as u32);
        self.block.words.extend_from_slice(value);
        self.block.words.extend_from_slice(unknown);
    }

    /// Returns the number of words of a signal's value.
    pub fn words(&self, signal: usize) -> usize {
        self.words[signal]
    }

    fn end(&mut self) -> std::result::Result<(), Disconnected> {
        let Some((at, marks)) = self.at.take() else { return Ok(()) };
        let end = self.block.changes.len();
        self.block.instants.push(Instant { at, marks, end });
        if self.block.words.len() + self.block.instants.len() < BLOCK {
            return Ok(());
        }
        self.blocks.send(Ok(std::mem::take(&mut self.block))).map_err(|_| Disconnected)
    }

    fn finish(mut self, result: Result<()>) {
        // That nobody listens any more is no fault of the reader.
        if self.end().is_ok() {
            let _ = self.blocks.send(Ok(self.block));
        }
        if let Err(error) = result {
            let _ = self.blocks.send(Err(error));
        }
    }
}

/// Receiving end of the stream: a reader of a source's changes, in order.
pub struct Cursor {
    blocks: Receiver<Result<Block>>,
    block: Block,
    instant: usize,
    change: usize,
    word: usize,
    /// Flag that stops the reader.
    pub(super) stop: Arc<AtomicBool>,
    /// Values after the last instant taken.
    pub state: SourceState,
}

impl Cursor {
    /// Runs `read` in a thread of the given name.
    pub(super) fn spawn(
        widths: &[u32],
        read: impl FnOnce(&mut Feed) -> Result<()> + Send + 'static,
    ) -> Cursor {
        let (sender, blocks) = sync_channel(DEPTH);
        let words = widths.iter().map(|&width| (width as usize).div_ceil(64)).collect();
        let mut feed = Feed { blocks: sender, block: Block::default(), words, at: None };
        let failed = feed.blocks.clone();
        let spawned = thread::Builder::new().spawn(move || {
            // A reader that panics must not look like one that has come to the end.
            let result = guarded("reader", || read(&mut feed));
            feed.finish(result);
        });
        if let Err(source) = spawned {
            let error = tofsim::error::Error::io(std::path::Path::new("thread"), "create")(source);
            let _ = failed.try_send(Err(error));
        }
        let (block, state) = (Block::default(), SourceState::new(widths));
        Cursor { blocks, block, instant: 0, change: 0, word: 0, stop: Arc::default(), state }
    }

    /// Returns the place of the next instant; `None` at the end.
    ///
    /// # Errors
    /// If the source cannot be read any further, or is stopped.
    #[inline]
    pub fn peek(&mut self) -> Result<Option<u64>> {
        while self.instant == self.block.instants.len() {
            poll_stop(Some(&self.stop))?;
            self.block = match self.blocks.recv_timeout(LOOK) {
                Ok(block) => block?,
                Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            };
            (self.instant, self.change, self.word) = (0, 0, 0);
        }
        Ok(Some(self.block.instants[self.instant].at))
    }

    /// Applies the next instant to the state, and calls `touched` with each signal in it.
    #[inline]
    pub fn take(&mut self, mut touched: impl FnMut(usize)) -> Marks {
        let Some(&Instant { marks, end, .. }) = self.block.instants.get(self.instant) else {
            return Marks::default();
        };
        self.instant += 1;
        while self.change < end {
            let signal = self.block.changes[self.change] as usize;
            self.change += 1;
            let count = self.state.range(signal).len();
            let words = &self.block.words[self.word..self.word + 2 * count];
            self.word += words.len();
            let (value, unknown) = words.split_at(count);
            self.state.set(signal, value, unknown);
            touched(signal);
        }
        marks
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use tofsim::error::Error;

    use super::*;

    #[test]
    fn what_is_put_in_comes_out_in_order() {
        let mut cursor = Cursor::spawn(&[1, 70], |feed| {
            for at in 0..100_000u64 {
                let _ = feed.at(at * 2);
                feed.change(0, &[at % 2], &[0]);
                if at % 3 == 0 {
                    feed.change(1, &[at, 1], &[0, 2]);
                    feed.mark(|marks| marks.trigger = true);
                }
            }
            Ok(())
        });
        assert_eq!(cursor.state.unknown(1), [u64::MAX, 0x3f]);
        for at in 0..100_000u64 {
            assert_eq!(cursor.peek().unwrap(), Some(at * 2));
            let mut touched = Vec::new();
            let marks = cursor.take(|signal| touched.push(signal));
            assert_eq!(touched.len(), 1 + usize::from(at % 3 == 0));
            assert_eq!(marks.trigger, at % 3 == 0);
            assert_eq!(cursor.state.value(0), [at % 2]);
            assert_eq!(cursor.state.value(1), [at / 3 * 3, 1]);
        }
        assert_eq!(cursor.peek().unwrap(), None);
    }

    #[test]
    fn an_error_comes_after_what_was_read_before_it() {
        let mut cursor = Cursor::spawn(&[1], |feed| {
            let _ = feed.at(5);
            Err(tofsim::error::Input::new("a.vcd", "broken").into())
        });
        assert_eq!(cursor.peek().unwrap(), Some(5));
        cursor.take(|_| ());
        assert_eq!(cursor.peek().unwrap_err().to_string(), "a.vcd: broken");
    }

    #[test]
    fn who_waits_for_a_reader_can_be_stopped() {
        let mut cursor = Cursor::spawn(&[1], |feed| {
            while feed.at(0).is_ok() {
                thread::sleep(LOOK);
            }
            Ok(())
        });
        let stop = Arc::clone(&cursor.stop);
        let setter = thread::spawn(move || {
            thread::sleep(LOOK);
            stop.store(true, Ordering::Relaxed);
        });
        assert!(matches!(cursor.peek(), Err(Error::Interrupted)));
        setter.join().unwrap();
    }

    #[test]
    fn a_reader_that_nobody_listens_to_stops() {
        let cursor = Cursor::spawn(&[1], |feed| {
            let mut at = 0;
            while feed.at(at).is_ok() {
                at += 1;
            }
            Ok(())
        });
        drop(cursor);
    }
}
