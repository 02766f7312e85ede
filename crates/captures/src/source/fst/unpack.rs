//! Decompression of the parts of an FST file, with a check of the stated size.

use lz4_flex::block::decompress;
use miniz_oxide::DataFormat;
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::stream::{InflateState, inflate};
use miniz_oxide::inflate::{decompress_to_vec_with_limit, decompress_to_vec_zlib_with_limit};
use miniz_oxide::{MZFlush, MZStatus};

use super::super::span::{Checked, Fault, at_most};

/// Size limit of a decompressed part [bytes].
pub(super) const LARGEST: u64 = 1 << 29;
/// Largest compression ratios of deflate and of LZ4 [1], and an allowance for short parts [bytes].
const DEFLATED: u64 = 1032;
const LZ4: u64 = 255;
const SOME: u64 = 64;
/// Size of a gzip header without optional fields [bytes].
const GZIP: usize = 10;

/// Returns the largest size to which `packed` bytes can decompress [bytes].
pub(super) fn most(packed: u64, is_deflated: bool) -> u64 {
    packed
        .saturating_mul(if is_deflated { DEFLATED } else { LZ4 })
        .saturating_add(SOME)
        .min(LARGEST)
}

/// Decompresses zlib's format. Data of the stated size are not compressed.
pub(super) fn zlib(packed: &[u8], size: u64, what: &str) -> Checked<Vec<u8>> {
    if packed.len() as u64 == size {
        return Ok(packed.to_vec());
    }
    let size = at_most(what, size, most(packed.len() as u64, true))?;
    whole(decompress_to_vec_zlib_with_limit(packed, size as usize).ok(), size, what)
}

/// Decompresses gzip's format.
pub(super) fn gzip(packed: &[u8], size: u64, what: &str) -> Checked<Vec<u8>> {
    let body = gzip_body(packed, what)?;
    let size = at_most(what, size, most(body.len() as u64, true))?;
    whole(decompress_to_vec_with_limit(body, size as usize).ok(), size, what)
}

/// Compresses to gzip's format, without the checksum at its end, which is not read.
pub(super) fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let header = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255];
    [&header[..], &compress_to_vec(bytes, 1)].concat()
}

fn gzip_body<'a>(packed: &'a [u8], what: &str) -> Checked<&'a [u8]> {
    match packed {
        [0x1f, 0x8b, 8, 0, ..] if packed.len() >= GZIP => Ok(&packed[GZIP..]),
        _ => Err(Fault::of(what, "expected gzip's header")),
    }
}

/// Decompresses the first `size` bytes of gzip's format step by step, as the data may be much longer.
pub(super) fn gzip_prefix(packed: &[u8], size: u64, what: &str) -> Checked<Vec<u8>> {
    let mut body = gzip_body(packed, what)?;
    let size = at_most(what, size, most(body.len() as u64, true))? as usize;
    let (mut state, mut unpacked) = (InflateState::new_boxed(DataFormat::Raw), Vec::new());
    let mut chunk = vec![0; 1 << 16];
    while unpacked.len() < size {
        let step = inflate(&mut state, body, &mut chunk, MZFlush::None);
        body = &body[step.bytes_consumed..];
        unpacked.extend_from_slice(&chunk[..step.bytes_written]);
        match step.status {
            Ok(MZStatus::Ok) => {}
            _ => break,
        }
    }
    unpacked.truncate(size);
    whole(Some(unpacked), size as u64, what)
}

/// Decompresses LZ4's block format.
pub(super) fn lz4(packed: &[u8], size: u64, what: &str) -> Checked<Vec<u8>> {
    let size = at_most(what, size, most(packed.len() as u64, false))?;
    whole(decompress(packed, size as usize).ok(), size, what)
}

fn whole(unpacked: Option<Vec<u8>>, size: u64, what: &str) -> Checked<Vec<u8>> {
    match unpacked {
        Some(unpacked) if unpacked.len() as u64 == size => Ok(unpacked),
        Some(unpacked) => {
            let expected = format!("unpacks to {} bytes", unpacked.len());
            Err(Fault::value(what, size, expected))
        }
        None => Err(Fault::value(what, size, "cannot be unpacked to so many bytes")),
    }
}
