//! The chunks of an FTR file.

use std::convert::Infallible;
use std::io::{Error as IoError, Write};

use minicbor::Encoder;
use minicbor::data::Tag;
use minicbor::encode::Error as EncodeError;

use tofsim::error::Result;
use tofsim::files::output::OutputFile;

/// Tag of self-described CBOR.
const SELF_DESCRIBED: u64 = 55799;

/// Result of encoding into memory.
pub(super) type Encoded<T> = std::result::Result<T, EncodeError<Infallible>>;

/// Encodes into memory.
pub(super) type Memory<'a> = Encoder<&'a mut Vec<u8>>;

/// Returns what `fill` encodes.
pub(super) fn encoded(fill: impl FnOnce(&mut Memory) -> Encoded<()>) -> Encoded<Vec<u8>> {
    let mut content = Vec::new();
    fill(&mut Encoder::new(&mut content))?;
    Ok(content)
}

/// The file, a chunk after another.
pub(super) struct Chunks(OutputFile);

impl Chunks {
    /// Begins the list of chunks.
    pub(super) fn create(file: OutputFile) -> Result<Self> {
        let mut chunks = Chunks(file);
        let head = encoded(|cbor| cbor.tag(Tag::new(SELF_DESCRIBED))?.begin_array()?.ok());
        let head = chunks.checked(head)?;
        chunks.put(&head)?;
        Ok(chunks)
    }

    /// Writes a chunk, with parameters before its content.
    pub(super) fn write(&mut self, tag: u64, parameters: &[u64], content: &[u8]) -> Result<()> {
        let head = encoded(|cbor| {
            cbor.tag(Tag::new(tag))?;
            if !parameters.is_empty() {
                cbor.array(parameters.len() as u64 + 1)?;
            }
            for parameter in parameters {
                cbor.u64(*parameter)?;
            }
            cbor.bytes_len(content.len() as u64)?.ok()
        });
        let head = self.checked(head)?;
        self.put(&head)?;
        self.put(content)
    }

    /// Writes a chunk whose content is a list without a length.
    pub(super) fn write_list(&mut self, tag: u64, parameters: &[u64], items: &[u8]) -> Result<()> {
        let [begin, end] =
            [encoded(|cbor| cbor.begin_array()?.ok()), encoded(|cbor| cbor.end()?.ok())];
        let content = [&self.checked(begin)?, items, &self.checked(end)?].concat();
        self.write(tag, parameters, &content)
    }

    /// Ends the list of chunks.
    pub(super) fn finish(mut self) -> Result<OutputFile> {
        let end = self.checked(encoded(|cbor| cbor.end()?.ok()))?;
        self.put(&end)?;
        Ok(self.0)
    }

    /// Converts an error of encoding to one that names the file.
    pub(super) fn checked<T>(&self, encoded: Encoded<T>) -> Result<T> {
        encoded.map_err(|error| self.0.fault(IoError::other(error.to_string())))
    }

    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.0.write_all(bytes).map_err(|error| self.0.fault(error))
    }
}
