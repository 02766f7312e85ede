//! Writer of sections: a thread of its own compresses them where there is a second processor.

use std::io::{self, Write};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{JoinHandle, available_parallelism};

use super::section::Section;

/// Writer of sections to a file.
pub(super) enum Sections<W> {
    /// Compresses where it is called.
    Here(W),
    /// Compresses a section while the next one is gathered.
    Beside(Thread<W>),
}

/// The thread, and two sections that go round between it and the caller.
pub(super) struct Thread<W> {
    full: Option<SyncSender<Section>>,
    empty: Receiver<Section>,
    /// The second section, until the thread has the first.
    spare: Option<Section>,
    handle: Option<JoinHandle<io::Result<W>>>,
}

impl<W: Write + Send + 'static> Sections<W> {
    /// Creates a writer that appends sections of so many signals to `file`.
    pub(super) fn new(file: W, signals: usize) -> Self {
        if available_parallelism().is_ok_and(|processors| processors.get() > 1) {
            Sections::Beside(Thread::new(file, signals))
        } else {
            Sections::Here(file)
        }
    }

    /// Takes a section, and leaves an empty one in its place.
    ///
    /// # Errors
    /// If this section or the one before could not be written.
    pub(super) fn write(&mut self, section: &mut Section) -> io::Result<()> {
        match self {
            Sections::Here(file) => section.write(file),
            Sections::Beside(thread) => thread.write(section),
        }
    }

    /// Returns the file once all sections are written.
    ///
    /// # Errors
    /// If a section could not be written.
    pub(super) fn finish(self) -> io::Result<W> {
        match self {
            Sections::Here(file) => Ok(file),
            Sections::Beside(mut thread) => thread.end(),
        }
    }
}

impl<W: Write + Send + 'static> Thread<W> {
    fn new(mut file: W, signals: usize) -> Self {
        let (full, to_write) = sync_channel::<Section>(1);
        let (written, empty) = sync_channel(1);
        let write = move || {
            for mut section in to_write {
                section.write(&mut file)?;
                if written.send(section).is_err() {
                    break;
                }
            }
            Ok(file)
        };
        let (full, spare) = (Some(full), Some(Section::new(signals)));
        Thread { full, empty, spare, handle: Some(std::thread::spawn(write)) }
    }

    fn write(&mut self, section: &mut Section) -> io::Result<()> {
        let empty = self.spare.take().or_else(|| self.empty.recv().ok());
        if let (Some(empty), Some(full)) = (empty, &self.full)
            && full.send(std::mem::replace(section, empty)).is_ok()
        {
            return Ok(());
        }
        self.end().map(drop)
    }
}

impl<W> Thread<W> {
    /// Lets the thread finish its work; returns the file.
    fn end(&mut self) -> io::Result<W> {
        self.full = None;
        let ended = || io::Error::other("the thread that compresses the waveform has ended");
        self.handle.take().ok_or_else(ended)?.join().map_err(|_| ended())?
    }
}

impl<W> Drop for Thread<W> {
    /// Waits, so that a file that is given up is gone when the run ends.
    fn drop(&mut self) {
        drop(self.end());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that takes so many bytes and no more.
    struct Full(usize);

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn section(of: u8) -> Section {
        let mut section = Section::new(3);
        section.streams[1].resize(1000, of);
        section.times.push(of.into(), 0);
        section
    }

    #[test]
    fn a_thread_writes_what_the_caller_would() {
        let file = |mut sections: Sections<Vec<u8>>| {
            for of in 1..20 {
                let mut section = section(of);
                sections.write(&mut section).unwrap();
                assert!(section.streams.iter().all(Vec::is_empty), "{of}");
                assert!(section.times.steps.is_empty(), "{of}");
            }
            sections.finish().unwrap()
        };
        let here = file(Sections::Here(Vec::new()));
        assert!(here.len() > 500, "{}", here.len());
        assert_eq!(file(Sections::Beside(Thread::new(Vec::new(), 3))), here);
    }

    #[test]
    fn an_error_of_the_file_comes_with_one_of_the_next_sections_or_at_the_end() {
        let mut sections = Sections::Beside(Thread::new(Full(100), 3));
        let errors = (0..9).filter_map(|of| sections.write(&mut section(of)).err());
        let kinds: Vec<_> = errors.map(|error| error.kind()).collect();
        assert_eq!(kinds[0], io::ErrorKind::StorageFull);
        assert!(sections.finish().is_err());
        let mut sections = Sections::Beside(Thread::new(Full(10), 3));
        sections.write(&mut section(1)).unwrap();
        let error = sections.finish().map(drop).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
