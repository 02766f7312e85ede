//! Arrays of whole numbers, rewritten as the library that reads MATLAB files expects them: it refuses integers of 8 bits
//! in arrays of floats, as GNU Octave stores small numbers, and arrays of the class int32.

use super::elements::{ByteOrder, DataElement, TAG, data_element};

/// Type of an element that is an array.
const MATRIX: u32 = 14;
/// Types of elements with integers of 8 and 16 bits.
const INT8: u32 = 1;
const INT16: u32 = 3;
/// Types of elements with integers of at most 32 bits, that fit doubles: int8, uint8, int16, uint16, int32.
const WHOLE: std::ops::RangeInclusive<u32> = 1..=5;
/// Type of the flags of an array.
const FLAGS: u32 = 6;
/// Classes of arrays of numbers, doubles first.
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;
/// Parts of an array before its numbers: flags, lengths, name.
const BEFORE: usize = 3;

/// Returns an array of whole numbers as one of doubles, of which none is stored as 8 bits. Other elements, and damaged
/// ones, come back unchanged.
pub(super) fn widened(element: &[u8], order: ByteOrder) -> Vec<u8> {
    as_doubles(element, order).unwrap_or_else(|| element.to_vec())
}

/// Returns an array of whole numbers, rewritten; `None` if the element is none.
fn as_doubles(element: &[u8], order: ByteOrder) -> Option<Vec<u8>> {
    let matrix = data_element(element, order).filter(|matrix| matrix.kind == MATRIX)?;
    let (mut parts, mut rest) = (Vec::new(), matrix.data);
    while let Some(part) = data_element(rest, order) {
        let (whole, after) = rest.split_at(part.length);
        parts.push((part, whole));
        rest = after;
    }
    let (before, numbers) = parts.split_at_checked(BEFORE)?;
    let flags = before[0].0.data;
    let word = order.word(flags.first_chunk()?);
    let is_whole = |(part, _): &(DataElement, &[u8])| WHOLE.contains(&part.kind);
    if !NUMBERS.contains(&(word & 0xff)) || numbers.is_empty() || !numbers.iter().all(is_whole) {
        return None;
    }
    let word = order.bytes(word & !0xff | NUMBERS.start());
    let mut all = stored(FLAGS, [&word, &flags[word.len()..]].concat(), order);
    before[1..].iter().for_each(|(_, whole)| all.extend_from_slice(whole));
    for (part, whole) in numbers {
        if part.kind == INT8 {
            let wide = part.data.iter().flat_map(|&byte| order.half(i16::from(byte as i8)));
            all.extend(stored(INT16, wide.collect(), order));
        } else {
            all.extend_from_slice(whole);
        }
    }
    Some(stored(MATRIX, all, order))
}

/// Returns an element with its tag, padded to whole tags.
fn stored(kind: u32, data: Vec<u8>, order: ByteOrder) -> Vec<u8> {
    let tag = [order.bytes(kind), order.bytes(data.len() as u32)].concat();
    let mut element = [tag, data].concat();
    element.resize(element.len().next_multiple_of(TAG), 0);
    element
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_become_doubles_of_16_bits_at_least_and_nothing_else_changes() {
        let order = ByteOrder::Little;
        let part = |kind, data: &[u8]| stored(kind, data.to_vec(), order);
        let array = |class: u8, numbers: Vec<u8>| {
            let flags = part(FLAGS, &[class, 8, 0, 0, 1, 0, 0, 0]);
            let lengths = part(5, &[1, 0, 0, 0, 3, 0, 0, 0]);
            // A name of four letters at most stands in its tag.
            let name = [1, 0, 2, 0, b'b', b'1', 0, 0].to_vec();
            part(MATRIX, &[flags, lengths, name, numbers].concat())
        };
        let small = part(INT8, &[1, 0xff, 0x80]);
        let wide = part(INT16, &[1, 0, 0xff, 0xff, 0x80, 0xff]);
        for class in [6, 7, 8, 12] {
            assert_eq!(widened(&array(class, small.clone()), order), array(6, wide.clone()));
            assert_eq!(widened(&array(class, wide.clone()), order), array(6, wide.clone()));
        }
        // So do three numbers that stand in their tag.
        let packed = vec![1, 0, 3, 0, 1, 0xff, 0x80, 0];
        assert_eq!(widened(&array(6, packed), order), array(6, wide));
        for other in [array(6, part(9, &[0; 24])), array(4, small.clone()), array(6, Vec::new())] {
            assert_eq!(widened(&other, order), other);
        }
        let cut = &array(8, small)[..20];
        assert_eq!(widened(cut, order), cut);
    }
}
