//! Pages of Parquet files with checksums, which the library reads and does not write.

use parquet::column::page::{CompressedPage, PageWriteSpec, PageWriter};
use parquet::errors::Result;
use parquet::file::writer::{SerializedPageWriter, TrackedWrite};

/// Fields of a page's header before the checksum, each a byte and a number: type, size, and compressed size.
const BEFORE: usize = 3;
/// First byte of the field of the checksum: the next field, a number of 32 bits.
const FIELD: u8 = 0x15;
/// Difference of the first byte of a field whose number is one nearer to that of the field before.
const NEARER: u8 = 0x10;

/// Writer of the pages of one column into memory.
pub(super) struct ChecksummedPages<'a>(&'a mut Vec<u8>);

impl<'a> ChecksummedPages<'a> {
    /// Creates a writer that appends to `bytes`.
    pub fn new(bytes: &'a mut Vec<u8>) -> Self {
        ChecksummedPages(bytes)
    }
}

impl PageWriter for ChecksummedPages<'_> {
    fn write_page(&mut self, page: CompressedPage) -> Result<PageWriteSpec> {
        let mut plain = TrackedWrite::new(Vec::new());
        let data = page.data().len();
        let checksum = crc32fast::hash(page.data());
        let mut spec = SerializedPageWriter::new(&mut plain).write_page(page)?;
        let plain = plain.into_inner()?;
        let header = plain.len() - data;
        let (before, after) = plain.split_at(fields(&plain[..header], BEFORE));
        let field = [&[FIELD][..], &number(checksum as i32)].concat();
        spec.offset = self.0.len() as u64;
        spec.bytes_written += field.len() as u64;
        spec.compressed_size += field.len();
        spec.uncompressed_size += field.len();
        self.0.extend([before, &field, &[after[0] - NEARER], &after[1..]].concat());
        Ok(spec)
    }

    fn close(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Returns the length of the first fields of a header in Thrift's compact protocol, if they are numbers.
fn fields(header: &[u8], count: usize) -> usize {
    (0..count).fold(0, |begin, _| {
        let number = header[begin + 1..].iter().take_while(|byte| **byte >= 0x80).count();
        begin + 2 + number
    })
}

/// Encodes a number as Thrift's compact protocol does: zigzag, seven bits a byte, the least first.
fn number(value: i32) -> Vec<u8> {
    let mut rest = ((value << 1) ^ (value >> 31)) as u32;
    let mut bytes = Vec::new();
    while rest >= 0x80 {
        bytes.push(rest as u8 | 0x80);
        rest >>= 7;
    }
    bytes.push(rest as u8);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_protocol() {
        assert_eq!(number(0), [0]);
        assert_eq!(number(-1), [1]);
        assert_eq!(number(150), [0xac, 0x02]);
        assert_eq!(number(i32::MIN), [0xff, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(fields(&[0x15, 0x04, 0x15, 0xac, 0x02, 0x15, 0x00, 0x2c], 3), 7);
    }
}
