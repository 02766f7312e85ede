//! The compressed parts of a MATLAB file, unpacked with a bound: the library that reads such files
//! unpacks whatever there is, and a thousandth of a gigabyte of zeros is a small file. Elements that are no arrays are
//! left out, because it prints them on standard output; whole numbers are widened on the way.

use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

use super::elements::{ByteOrder, TAG, tag};
use super::widen::widened;

/// Most that a file may hold, unpacked [bytes].
pub(super) const LARGEST: usize = 64 << 20;
/// Bytes before the first element.
const HEADER: usize = 128;
/// Types of an element that is an array, and of one that is another element, compressed.
const ARRAY: u32 = 14;
const COMPRESSED: u32 = 15;
/// Bits of the type, whose others are the length of a short element.
const KIND: u32 = 0xffff;

/// The same file with arrays alone, and nothing compressed; what is no MATLAB file comes back as it is.
///
/// # Errors
/// When it is too large, or a part cannot be unpacked, in words.
pub(super) fn unpacked(file: &[u8]) -> Result<Vec<u8>, String> {
    let too_large = || {
        let most = LARGEST >> 20;
        format!("holds more than {most} MiB; expected the network's arrays alone")
    };
    if file.len() > LARGEST {
        return Err(too_large());
    }
    let Some((header, mut rest)) = file.split_at_checked(HEADER) else {
        return Ok(file.to_vec());
    };
    let order = if header.ends_with(b"MI") { ByteOrder::Big } else { ByteOrder::Little };
    let mut whole = header.to_vec();
    while let Some((kind, length)) = tag(rest, order) {
        let (element, after) = rest.split_at(rest.len().min(TAG + length));
        if kind != COMPRESSED {
            // Aligned by the padding that stands there, too.
            let length = if kind > KIND { 0 } else { length.next_multiple_of(8) };
            let (element, after) = rest.split_at(rest.len().min(TAG + length));
            if kind & KIND == ARRAY {
                whole.append(&mut widened(element, order));
            }
            rest = after;
            continue;
        }
        let left = LARGEST.saturating_sub(whole.len());
        let inner = decompress_to_vec_zlib_with_limit(&element[TAG..], left);
        let mut inner = inner.map_err(|error| match error.status {
            TINFLStatus::HasMoreOutput => too_large(),
            status => format!("a compressed part cannot be unpacked ({status:?})"),
        })?;
        if tag(&inner, order).is_none_or(|(kind, _)| kind & KIND != ARRAY) {
            return Err("a compressed part holds no array".to_owned());
        }
        inner.resize(inner.len().next_multiple_of(8), 0);
        whole.append(&mut widened(&inner, order));
        rest = after;
    }
    whole.extend_from_slice(rest);
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::deflate::compress_to_vec_zlib;

    fn file(parts: &[(u32, &[u8])]) -> Vec<u8> {
        let mut file = vec![b' '; HEADER - 4];
        file.extend([0, 1, b'I', b'M']);
        for (kind, data) in parts {
            file.extend(kind.to_le_bytes());
            file.extend((data.len() as u32).to_le_bytes());
            file.extend_from_slice(data);
        }
        file
    }

    fn element(data: &[u8]) -> Vec<u8> {
        [&14u32.to_le_bytes()[..], &(data.len() as u32).to_le_bytes(), data].concat()
    }

    #[test]
    fn compressed_parts_are_unpacked_in_their_places() {
        let (a, b) = (element(&[1; 16]), element(&[2; 8]));
        let packed = compress_to_vec_zlib(&b, 6);
        let mixed = file(&[(14, &[1; 16]), (COMPRESSED, &packed), (14, &[1; 16])]);
        assert_eq!(unpacked(&mixed).unwrap()[HEADER..], [a.clone(), b, a].concat());
        let others = file(&[(9, &[3; 8]), (14, &[1; 16]), (2, &[4; 8]), (0x4_0001, &[])]);
        assert_eq!(unpacked(&others).unwrap()[HEADER..], element(&[1; 16]));
        assert_eq!(unpacked(b"no MATLAB file").unwrap(), b"no MATLAB file");
    }

    #[test]
    fn what_is_too_large_or_packed_twice_is_refused() {
        let large = compress_to_vec_zlib(&element(&vec![0; LARGEST]), 6);
        assert!(large.len() < 1 << 20);
        let error = unpacked(&file(&[(COMPRESSED, &large)])).unwrap_err();
        assert!(error.contains("more than 64 MiB"), "{error}");
        // Many parts, none of which is too large.
        let part = compress_to_vec_zlib(&element(&vec![0; LARGEST / 3]), 6);
        let error = unpacked(&file(&[(COMPRESSED, &part[..]); 4])).unwrap_err();
        assert!(error.contains("more than 64 MiB"), "{error}");
        let twice = [&COMPRESSED.to_le_bytes()[..], &[0; 4]].concat();
        let twice = file(&[(COMPRESSED, &compress_to_vec_zlib(&twice, 6))]);
        assert!(unpacked(&twice).unwrap_err().contains("no array"));
        assert!(unpacked(&file(&[(COMPRESSED, b"none")])).unwrap_err().contains("unpacked"));
        assert!(unpacked(&vec![0; LARGEST + 1]).unwrap_err().contains("more than 64 MiB"));
    }
}
