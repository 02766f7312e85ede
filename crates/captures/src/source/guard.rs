//! Watches over what the waveform library reads and over the library itself.
//!
//! The library takes a VCD's time for granted: where it goes back it prints a line on standard
//! output and leaves changes out. And on many a fault it panics. Both become errors here.

use std::io::{self, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Once, OnceLock};
use std::thread;

use tofsim::error::{self, Input};

use super::remark::Remark;

/// Name of the threads that read, by which a panic of theirs is known.
pub(super) const READER: &str = "tofsim reader";

/// Passes a VCD on, and fails where a time stamp goes back.
pub(super) struct InOrder<R> {
    inner: R,
    /// Offset of what is read next.
    offset: u64,
    /// Offset up to which it has been looked at.
    seen: u64,
    line: u64,
    begin_of_line: bool,
    /// The command that the line belongs to, if it may be a remark.
    remark: Option<Remark>,
    /// Digits of the time stamp under way.
    stamp: Option<Stamp>,
    last: u64,
    /// The fault found, which the library would pass on without its line.
    fault: Arc<OnceLock<Fault>>,
}

/// A time stamp as far as it has been read.
#[derive(Clone, Copy, Debug, Default)]
struct Stamp {
    time: u64,
    digits: u32,
}

impl<R> InOrder<R> {
    /// Around a file from its begin; a fault goes into `fault` too.
    pub(super) fn new(inner: R, fault: Arc<OnceLock<Fault>>) -> Self {
        InOrder {
            inner,
            offset: 0,
            seen: 0,
            line: 1,
            begin_of_line: true,
            remark: None,
            stamp: None,
            last: 0,
            fault,
        }
    }

    /// The same around a file that is not text, in which nothing is looked at.
    pub(super) fn unwatched(self) -> Self {
        InOrder { seen: u64::MAX, ..self }
    }

    /// Looks at bytes; how many of them stand before a fault.
    fn look(&mut self, bytes: &[u8]) -> usize {
        let mut rest = bytes;
        match self.follow(&mut rest) {
            Ok(()) => bytes.len(),
            Err(fault) => {
                // There is no second fault: nothing is read behind the first.
                let _ = self.fault.set(fault);
                bytes.len() - rest.len()
            }
        }
    }

    fn follow(&mut self, rest: &mut &[u8]) -> Result<(), Fault> {
        while let Some(&byte) = rest.first() {
            if let Some(stamp) = self.stamp {
                *rest = &rest[1..];
                self.stamp = match byte {
                    b'0'..=b'9' => Some(self.longer(stamp, byte)?),
                    _ if stamp.digits == 0 || !byte.is_ascii_whitespace() => {
                        return Err(self.fault("expected a time behind #".into()));
                    }
                    _ => {
                        self.passed(stamp.time)?;
                        None
                    }
                };
                if byte == b'\n' {
                    self.next_line();
                }
                continue;
            }
            if self.begin_of_line {
                self.begin_of_line = false;
                if byte == b'$' && self.remark.is_none() {
                    self.remark = Some(Remark::default());
                }
                if byte == b'#' && self.remark.is_none() {
                    self.stamp = Some(Stamp::default());
                    *rest = &rest[1..];
                    continue;
                }
            }
            match rest.iter().position(|&byte| byte == b'\n') {
                Some(end) => {
                    self.pass(&rest[..end]);
                    *rest = &rest[end + 1..];
                    self.next_line();
                }
                None => {
                    self.pass(rest);
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    fn pass(&mut self, bytes: &[u8]) {
        if let Some(remark) = &mut self.remark {
            remark.take(bytes);
        }
    }

    fn next_line(&mut self) {
        self.line += 1;
        self.begin_of_line = true;
        self.remark = self.remark.take().filter(Remark::goes_on);
    }

    fn longer(&self, stamp: Stamp, digit: u8) -> Result<Stamp, Fault> {
        let longer = stamp.time.checked_mul(10);
        let longer = longer.and_then(|time| time.checked_add(u64::from(digit - b'0')));
        let longer = longer.map(|time| Stamp { time, digits: stamp.digits + 1 });
        longer.ok_or_else(|| self.fault("expected a time below 2^64".into()))
    }

    fn passed(&mut self, stamp: u64) -> Result<(), Fault> {
        if stamp < self.last {
            let last = self.last;
            return Err(self.fault(format!("time goes back from {last} to {stamp}")));
        }
        self.last = stamp;
        Ok(())
    }

    fn fault(&self, text: String) -> Fault {
        Fault { line: self.line as usize, text }
    }
}

impl<R: Read> Read for InOrder<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if let Some(fault) = self.fault.get() {
            return Err(io::Error::new(io::ErrorKind::InvalidData, fault.text.clone()));
        }
        let mut count = self.inner.read(bytes)?;
        if count == 0
            && let Some(stamp) = self.stamp.take()
            && let Err(fault) = self.passed(stamp.time)
        {
            let text = fault.text.clone();
            // There was none before.
            let _ = self.fault.set(fault);
            return Err(io::Error::new(io::ErrorKind::InvalidData, text));
        }
        let known = self.seen.saturating_sub(self.offset).min(count as u64) as usize;
        count = known + self.look(&bytes[known..count]);
        self.offset += count as u64;
        self.seen = self.seen.max(self.offset);
        Ok(count)
    }
}

impl<R: Seek> Seek for InOrder<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.offset = self.inner.seek(to)?;
        Ok(self.offset)
    }
}

/// A fault with its line.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    /// Counted from 1.
    pub(super) line: usize,
    pub(super) text: String,
}

/// Lets the library do something; a panic of it is an error about `source`.
pub(super) fn guarded<T>(
    source: &str,
    work: impl FnOnce() -> error::Result<T>,
) -> error::Result<T> {
    silence();
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(result) => result,
        Err(_) => Err(Input::new(source, "is damaged, or not as its format asks").into()),
    }
}

/// Keeps panics in reading threads, which become errors, off standard error.
fn silence() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if thread::current().name() != Some(READER) {
                before(panic);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, chunk: usize) -> Result<(), String> {
        let fault = Arc::new(OnceLock::new());
        let mut guard = InOrder::new(text.as_bytes(), Arc::clone(&fault));
        let mut buffer = vec![0; chunk];
        loop {
            match guard.read(&mut buffer) {
                Ok(0) => return Ok(()),
                Ok(_) => {}
                Err(error) => {
                    let fault = fault.get().unwrap();
                    assert_eq!(error.to_string(), fault.text);
                    return Err(format!("{}: {}", fault.line, fault.text));
                }
            }
        }
    }

    #[test]
    fn time_may_stand_still_but_not_go_back() {
        for chunk in 1..20 {
            assert_eq!(read("$end\n#0\n0#\n#5\nb01 #\n1!\n#5\n#70\n", chunk), Ok(()));
            assert_eq!(read("#9\n$comment\n#0\n$end\n#9\n$comment #0 $end\n#10\n", chunk), Ok(()));
            let back = read("$end\n#0\n0#\n#50\n1!\n#49\n1!\n", chunk);
            assert_eq!(back.unwrap_err(), "6: time goes back from 50 to 49");
        }
    }

    #[test]
    fn a_time_beyond_64_bits_is_refused_with_its_line() {
        let error = read("#1\n#99999999999999999999\n", 7).unwrap_err();
        assert_eq!(error, "2: expected a time below 2^64");
    }
}
