//! Elements of a MATLAB file of level 5: type, length, data, padding.

/// Bytes of an element's type and length.
pub(super) const TAG: usize = 8;

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug)]
pub(super) enum ByteOrder {
    /// Least significant first.
    Little,
    /// Most significant first.
    Big,
}

/// An element.
pub(super) struct DataElement<'a> {
    pub kind: u32,
    pub data: &'a [u8],
    /// Bytes with type, length and padding.
    pub length: usize,
}

impl ByteOrder {
    /// Reads a number of 32 bits.
    pub fn word(self, bytes: &[u8; 4]) -> u32 {
        match self {
            ByteOrder::Little => u32::from_le_bytes(*bytes),
            ByteOrder::Big => u32::from_be_bytes(*bytes),
        }
    }

    /// Writes a number of 32 bits.
    pub fn bytes(self, word: u32) -> [u8; 4] {
        match self {
            ByteOrder::Little => word.to_le_bytes(),
            ByteOrder::Big => word.to_be_bytes(),
        }
    }

    /// Writes a number of 16 bits.
    pub fn half(self, number: i16) -> [u8; 2] {
        match self {
            ByteOrder::Little => number.to_le_bytes(),
            ByteOrder::Big => number.to_be_bytes(),
        }
    }
}

/// Returns the type and length of the element that begins here, as they stand.
pub(super) fn tag(bytes: &[u8], order: ByteOrder) -> Option<(u32, usize)> {
    let (kind, rest) = bytes.split_first_chunk()?;
    Some((order.word(kind), order.word(rest.first_chunk()?) as usize))
}

/// Returns the element that begins here, if all of it is there. One of four bytes at most has its data within the tag.
pub(super) fn data_element(bytes: &[u8], order: ByteOrder) -> Option<DataElement<'_>> {
    let (kind, length) = tag(bytes, order)?;
    if kind >> 16 != 0 {
        let data = bytes[4..TAG].get(..(kind >> 16) as usize)?;
        return Some(DataElement { kind: kind & 0xffff, data, length: TAG });
    }
    let data = bytes[TAG..].get(..length)?;
    let length = (TAG + length).next_multiple_of(TAG).min(bytes.len());
    Some(DataElement { kind, data, length })
}
