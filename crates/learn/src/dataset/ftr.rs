//! FTR files: transactions in streams, with attributes and relations, as LWTR4SC and Surfer have them.
//!
//! CBOR (RFC 8949) as in the format's description, <https://github.com/Minres/LWTR4SC>: a self-described array of
//! tagged chunks. Chunks are not compressed, because `ftr_parser` 0.3.0 decompresses only those of a file that it opens
//! itself, and not those that it gets as bytes.

use std::borrow::Cow;
use std::path::Path;

use minicbor::Encoder;
use minicbor::data::Tag;

use tofsim::error::Result;
use tofsim::files::output::OutputFile;

mod chunks;
mod dictionary;

use chunks::{Chunks, Encoded, Memory, encoded};
use dictionary::Dictionary;

/// Content of a chunk of transactions or relations from which on it is written [bytes].
const CHUNK: usize = 1 << 16;

/// Tags of chunks without compression.
const INFO: u64 = 6;
const DIRECTORY: u64 = 10;
const TRANSACTIONS: u64 = 12;
const RELATIONS: u64 = 14;
/// Tags within chunks.
const EPOCH: u64 = 1;
const STREAM: u64 = 16;
const GENERATOR: u64 = 17;
const EVENT: u64 = 6;

/// When the value of an attribute is known; each has its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// With the begin of the transaction.
    Begin = 7,
    /// With its end.
    End = 9,
}

/// Value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum FtrValue<'a> {
    /// A level.
    Flag(bool),
    /// A number with a sign.
    Signed(i64),
    /// A number without a sign.
    Unsigned(u64),
    /// A real number; readers know single precision only.
    Real(f32),
    /// A text.
    Text(Cow<'a, str>),
}

/// An attribute of a transaction.
pub type FtrAttribute<'a> = (&'a str, Known, FtrValue<'a>);

/// A transaction in a stream, by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FtrPlace {
    /// Place of the stream among those of the file.
    pub stream: usize,
    /// Number of the transaction in the file.
    pub id: u64,
}

/// An FTR file under construction; nothing is left of it unless it is finished and put in place.
pub struct FtrWriter {
    chunks: Chunks,
    dictionary: Dictionary,
    /// Transactions of each stream that are not written yet.
    blocks: Vec<Block>,
    /// Relations that are not written yet.
    relations: Vec<u8>,
}

/// Transactions of a stream that are not written yet.
#[derive(Clone, Debug, Default)]
struct Block {
    content: Vec<u8>,
    /// First begin and last end.
    span: Option<[u64; 2]>,
}

impl FtrWriter {
    /// Begins a file of streams with these names, whose times count units of ten to `exponent` seconds. `record` is the
    /// first string of the dictionary that nothing refers to. The file states no date.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: &Path, exponent: i8, streams: &[&str], record: &str) -> Result<Self> {
        let mut chunks = Chunks::create(OutputFile::create(path)?)?;
        let info = encoded(|cbor| cbor.array(2)?.i8(exponent)?.tag(Tag::new(EPOCH))?.u8(0)?.ok());
        chunks.write(INFO, &[], &chunks.checked(info)?)?;
        let mut dictionary = Dictionary::default();
        dictionary.id(record);
        let directory = directory(streams, &mut dictionary);
        let directory = chunks.checked(directory)?;
        dictionary.write(&mut chunks)?;
        chunks.write(DIRECTORY, &[], &directory)?;
        let blocks = vec![Block::default(); streams.len()];
        Ok(FtrWriter { chunks, dictionary, blocks, relations: Vec::new() })
    }

    /// Adds a transaction with its begin and end.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn transaction(
        &mut self,
        place: FtrPlace,
        [begin, end]: [u64; 2],
        attributes: &[FtrAttribute],
    ) -> Result<()> {
        let generator = (self.blocks.len() + place.stream + 1) as u64;
        let block = &mut self.blocks[place.stream];
        let mut cbor = Encoder::new(&mut block.content);
        let mut encode_all = || {
            cbor.array(1 + attributes.len() as u64)?;
            cbor.tag(Tag::new(EVENT))?.array(4)?.u64(place.id)?.u64(generator)?;
            cbor.u64(begin)?.u64(end)?;
            let dictionary = &mut self.dictionary;
            attributes.iter().try_for_each(|attribute| encode(&mut cbor, attribute, dictionary))
        };
        self.chunks.checked(encode_all())?;
        let [first, last] = block.span.unwrap_or([begin, end]);
        block.span = Some([first.min(begin), last.max(end)]);
        if block.content.len() < CHUNK { Ok(()) } else { self.write_block(place.stream) }
    }

    /// Adds a relation from one transaction to another.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn relation(&mut self, name: &str, source: FtrPlace, sink: FtrPlace) -> Result<()> {
        let name = self.dictionary.id(name);
        let [from, to] = [source, sink].map(|place| place.stream as u64 + 1);
        let mut cbor = Encoder::new(&mut self.relations);
        let mut encode =
            || cbor.array(5)?.u64(name)?.u64(source.id)?.u64(sink.id)?.u64(from)?.u64(to)?.ok();
        self.chunks.checked(encode())?;
        if self.relations.len() < CHUNK { Ok(()) } else { self.write_relations() }
    }

    /// Completes the file, which is then to be put in place.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(mut self) -> Result<OutputFile> {
        for stream in 0..self.blocks.len() {
            self.write_block(stream)?;
        }
        self.write_relations()?;
        self.chunks.finish()
    }

    fn write_block(&mut self, stream: usize) -> Result<()> {
        let Block { content, span } = std::mem::take(&mut self.blocks[stream]);
        let Some([begin, end]) = span else { return Ok(()) };
        self.dictionary.write(&mut self.chunks)?;
        self.chunks.write_list(TRANSACTIONS, &[stream as u64 + 1, begin, end], &content)
    }

    fn write_relations(&mut self) -> Result<()> {
        let content = std::mem::take(&mut self.relations);
        if content.is_empty() {
            return Ok(());
        }
        self.dictionary.write(&mut self.chunks)?;
        self.chunks.write_list(RELATIONS, &[], &content)
    }
}

/// Encodes the streams and the one generator of each. Streams have the numbers from 1 on, generators those after them.
fn directory(streams: &[&str], dictionary: &mut Dictionary) -> Encoded<Vec<u8>> {
    let kind = dictionary.id("TRANSACTION");
    encoded(|cbor| {
        cbor.begin_array()?;
        for (stream, name) in streams.iter().enumerate() {
            let (stream, name) = (stream as u64 + 1, dictionary.id(name));
            cbor.tag(Tag::new(STREAM))?.array(3)?.u64(stream)?.u64(name)?.u64(kind)?;
        }
        for (stream, name) in streams.iter().enumerate() {
            let (stream, name) = (stream as u64 + 1, dictionary.id(name));
            let generator = streams.len() as u64 + stream;
            cbor.tag(Tag::new(GENERATOR))?.array(3)?.u64(generator)?.u64(name)?.u64(stream)?;
        }
        cbor.end()?.ok()
    })
}

/// Encodes an attribute: its name, the number of its type, and its value.
fn encode(
    cbor: &mut Memory,
    (name, known, value): &FtrAttribute,
    dictionary: &mut Dictionary,
) -> Encoded<()> {
    cbor.tag(Tag::new(*known as u64))?.array(3)?.u64(dictionary.id(name))?;
    match value {
        FtrValue::Flag(flag) => cbor.u8(0)?.bool(*flag)?,
        FtrValue::Signed(number) => cbor.u8(2)?.i64(*number)?,
        FtrValue::Unsigned(number) => cbor.u8(3)?.u64(*number)?,
        FtrValue::Real(number) => cbor.u8(4)?.f32(*number)?,
        FtrValue::Text(text) => cbor.u8(10)?.u64(dictionary.id(text))?,
    };
    Ok(())
}
