//! UARTBone, LiteX's protocol for a bus behind a serial port.
//!
//! A command is a byte, a length byte, and the address of a word (32 bits); a write goes on with its words, and a read
//! is answered by as many. The most significant byte comes first. A write has no answer. The bridge drops a command
//! whose next byte does not come within [`BRIDGE_TIMEOUT`].

use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// Silence after which the bridge waits for a new command.
pub const BRIDGE_TIMEOUT: Duration = Duration::from_millis(100);
/// Silence that is certainly longer.
const QUIET: Duration = Duration::from_millis(150);
/// Longest wait for silence.
const LONGEST_CHATTER: Duration = Duration::from_secs(2);
/// Most words of a command.
pub const MOST_WORDS: usize = 255;
/// Bytes of a word.
const WORD: usize = 4;

/// The commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Command {
    /// Writes words to consecutive addresses.
    Write = 1,
    /// Reads words from consecutive addresses.
    Read = 2,
    /// Writes words to one address, one after the other.
    WriteFixed = 3,
    /// Reads words from one address, one after the other.
    ReadFixed = 4,
}

impl Command {
    /// Returns the address of the word at a place in the command's data.
    fn address(self, first: u32, place: usize) -> u32 {
        match self {
            Command::Write | Command::Read => first.wrapping_add(place as u32),
            Command::WriteFixed | Command::ReadFixed => first,
        }
    }
}

/// A connection whose reads and writes fail with `TimedOut` or `WouldBlock` after a short time.
pub trait Link: Read + Write + Send {}

impl<L: Read + Write + Send> Link for L {}

/// Failure of a command.
#[derive(Debug)]
pub enum BusError {
    /// The answer did not come, or not all of it.
    Silent {
        /// Bytes that came.
        received: usize,
        /// Bytes of the whole answer.
        expected: usize,
    },
    /// The command could not be sent in time.
    Stuck,
    /// The connection is gone.
    Lost(io::Error),
}

/// The host's end of the protocol.
pub struct UartBone<L> {
    link: L,
    /// Longest silence within an answer.
    patience: Duration,
}

impl<L: Link> UartBone<L> {
    /// Speaks over a connection; an answer may be silent for as long as `patience`.
    pub fn new(link: L, patience: Duration) -> Self {
        UartBone { link, patience }
    }

    /// Returns the longest silence within an answer.
    pub fn patience(&self) -> Duration {
        self.patience
    }

    /// Reads consecutive words.
    ///
    /// # Errors
    /// When no whole answer comes, not even the second time.
    pub fn read(&mut self, address: u32, words: usize) -> Result<Vec<u32>, BusError> {
        self.read_by(Command::Read, address, words)
    }

    /// Reads words of one address, one after the other.
    ///
    /// # Errors
    /// When no whole answer comes, not even the second time.
    pub fn read_fixed(&mut self, address: u32, words: usize) -> Result<Vec<u32>, BusError> {
        self.read_by(Command::ReadFixed, address, words)
    }

    /// Writes consecutive words.
    ///
    /// # Errors
    /// When they cannot be sent.
    pub fn write(&mut self, address: u32, words: &[u32]) -> Result<(), BusError> {
        self.write_by(Command::Write, address, words)
    }

    /// Writes words to one address, one after the other.
    ///
    /// # Errors
    /// When they cannot be sent.
    pub fn write_fixed(&mut self, address: u32, words: &[u32]) -> Result<(), BusError> {
        self.write_by(Command::WriteFixed, address, words)
    }

    /// Discards input until the bridge has dropped whatever it took for a command.
    ///
    /// # Errors
    /// When the connection is gone.
    pub fn resynchronize(&mut self) -> Result<(), BusError> {
        let begun = Instant::now();
        let mut last = begun;
        let mut discarded = [0; 256];
        while last.elapsed() < QUIET && begun.elapsed() < LONGEST_CHATTER {
            if self.receive(&mut discarded)? > 0 {
                last = Instant::now();
            }
        }
        Ok(())
    }

    fn read_by(
        &mut self,
        command: Command,
        first: u32,
        words: usize,
    ) -> Result<Vec<u32>, BusError> {
        let mut all = Vec::with_capacity(words);
        while all.len() < words {
            let (address, count) = (command.address(first, all.len()), words - all.len());
            let count = count.min(MOST_WORDS);
            let answer = match self.ask(command, address, count) {
                Err(BusError::Silent { .. }) => {
                    self.resynchronize()?;
                    self.ask(command, address, count)
                }
                answer => answer,
            };
            all.extend(answer?);
        }
        Ok(all)
    }

    fn ask(&mut self, command: Command, address: u32, count: usize) -> Result<Vec<u32>, BusError> {
        self.send(&head(command, count, address))?;
        let mut bytes = vec![0; WORD * count];
        let (mut received, mut last) = (0, Instant::now());
        while received < bytes.len() {
            let more = self.receive(&mut bytes[received..])?;
            if more > 0 {
                last = Instant::now();
            } else if last.elapsed() > self.patience {
                return Err(BusError::Silent { received, expected: bytes.len() });
            }
            received += more;
        }
        let word = |bytes: &[u8]| bytes.iter().fold(0, |word, &byte| word << 8 | u32::from(byte));
        Ok(bytes.chunks(WORD).map(word).collect())
    }

    fn write_by(&mut self, command: Command, first: u32, words: &[u32]) -> Result<(), BusError> {
        for (part, words) in words.chunks(MOST_WORDS).enumerate() {
            let mut bytes =
                head(command, words.len(), command.address(first, part * MOST_WORDS)).to_vec();
            bytes.extend(words.iter().flat_map(|word| word.to_be_bytes()));
            self.send(&bytes)?;
        }
        Ok(())
    }

    fn send(&mut self, mut bytes: &[u8]) -> Result<(), BusError> {
        let begun = Instant::now();
        while !bytes.is_empty() {
            match self.link.write(bytes) {
                Ok(0) => return Err(BusError::Lost(ErrorKind::WriteZero.into())),
                Ok(sent) => bytes = &bytes[sent..],
                Err(error) if !passes(&error) => return Err(BusError::Lost(error)),
                Err(_) if begun.elapsed() > self.patience => return Err(BusError::Stuck),
                Err(_) => {}
            }
        }
        Ok(())
    }

    /// Receives what is there; nothing within the connection's own time-out is 0 bytes.
    fn receive(&mut self, bytes: &mut [u8]) -> Result<usize, BusError> {
        match self.link.read(bytes) {
            Ok(0) => Err(BusError::Lost(ErrorKind::UnexpectedEof.into())),
            Ok(received) => Ok(received),
            Err(error) if passes(&error) => Ok(0),
            Err(error) => Err(BusError::Lost(error)),
        }
    }
}

/// Returns whether an error is only that nothing came or went for a while.
fn passes(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

/// Returns the bytes of a command before its data.
fn head(command: Command, words: usize, address: u32) -> [u8; 6] {
    let [a, b, c, d] = address.to_be_bytes();
    // No command has more than MOST_WORDS.
    [command as u8, words as u8, a, b, c, d]
}
