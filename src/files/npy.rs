//! NumPy's `.npy` files: plain arrays that end where their headers say.

use std::io::{self, ErrorKind, Read};

use npyz::{DType, NpyFile, NpyHeader};

/// Longest accepted header of an `.npy` file; that of a plain array has 118 [bytes].
const NPY_HEADER: usize = 1024;
/// Largest number of digits in that header, so that the product of the lengths fits in 64 bits.
const NPY_DIGITS: usize = 18;

/// An array of a file.
pub type NpyInput<R> = NpyFile<Whole<R>>;

/// Reader of an array's numbers, which fails if anything follows them.
#[derive(Debug)]
pub struct Whole<R> {
    reader: R,
    /// Bytes of the array that are still to be read.
    left: u64,
}

/// Reads the header of a file. Reading the last of the array's numbers fails with [`ErrorKind::InvalidData`] if the
/// file goes on after them, as it does if the header says fewer than there are.
///
/// # Errors
/// If the header cannot be read or is refused.
pub fn open<R: Read>(mut reader: R) -> io::Result<NpyInput<R>> {
    let header = header(&mut reader)?;
    let size = match header.dtype() {
        DType::Plain(plain) => plain.size_field(),
        _ => 0,
    };
    let left = header.shape().iter().fold(size, |left, &length| left.saturating_mul(length));
    Ok(NpyFile::with_header(header, Whole { reader, left }))
}

impl<R: Read> Read for Whole<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let most = bytes.len().min(self.left.try_into().unwrap_or(usize::MAX));
        let read = self.reader.read(&mut bytes[..most])?;
        self.left -= read as u64;
        if read > 0 && self.left == 0 && self.reader.read(&mut [0])? > 0 {
            let expected = "the file goes on after the numbers that its header announces";
            return Err(io::Error::new(ErrorKind::InvalidData, expected));
        }
        Ok(read)
    }
}

/// Reads the header. A header unlike that of a plain array is refused before it is parsed, because nested brackets
/// take the parser exponential time.
///
/// # Errors
/// If the header cannot be read or is refused.
fn header(reader: &mut impl Read) -> io::Result<NpyHeader> {
    parse(reader).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => io::Error::other("the file ends within it"),
        _ => error,
    })
}

fn parse(reader: &mut impl Read) -> io::Result<NpyHeader> {
    let mut bytes = vec![0; 10];
    reader.read_exact(&mut bytes)?;
    let mut length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    if bytes[6] > 1 {
        let mut high = [0; 2];
        reader.read_exact(&mut high)?;
        bytes.extend(high);
        length |= usize::from(u16::from_le_bytes(high)) << 16;
    }
    if length > NPY_HEADER {
        return Err(io::Error::other(format!("a header of {length} bytes")));
    }
    let begin = bytes.len();
    bytes.resize(begin + length, 0);
    reader.read_exact(&mut bytes[begin..])?;
    let count = |of: fn(&u8) -> bool| bytes[begin..].iter().filter(|&byte| of(byte)).count();
    if count(|byte| b"([{".contains(byte)) > 2 || count(u8::is_ascii_digit) > NPY_DIGITS {
        return Err(io::Error::other("its header is not that of a plain array"));
    }
    NpyHeader::from_reader(&bytes[..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.bytes());
        bytes
    }

    #[test]
    fn a_plain_array_s_header_is_read() {
        let text = "{'descr': '<f8', 'fortran_order': False, 'shape': (8, 256), }\n";
        let header = header(&mut &file(text)[..]).unwrap();
        assert_eq!(header.shape(), [8, 256]);
    }

    #[test]
    fn what_follows_the_array_is_refused() {
        let text = "{'descr': '<u2', 'fortran_order': False, 'shape': (2,), }\n";
        let read = |data: &[u8]| {
            let bytes = [&file(text), data].concat();
            open(&bytes[..]).unwrap().into_vec::<u16>()
        };
        assert_eq!(read(&[1, 0, 2, 0]).unwrap(), [1, 2]);
        let kind = |data: &[u8]| read(data).unwrap_err().kind();
        assert_eq!(kind(&[1, 0, 2, 0, 3]), ErrorKind::InvalidData);
        assert_eq!(kind(&[1, 0, 2]), ErrorKind::UnexpectedEof);
    }

    #[test]
    fn what_the_parser_would_take_forever_for_or_overflow_on_is_refused() {
        let refused = |text: &str| header(&mut &file(text)[..]).err().unwrap().to_string();
        assert!(refused(&"[".repeat(60_000)).contains("a header of 60000 bytes"));
        assert!(refused(&"[".repeat(900)).contains("not that of a plain array"));
        let many = "{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999, 9999999999), }";
        assert!(refused(many).contains("not that of a plain array"));
        let cut = header(&mut &b"\x93NUMPY\x01"[..]).err().unwrap();
        assert_eq!(cut.to_string(), "the file ends within it");
    }
}
