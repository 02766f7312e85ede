//! A 64-bit hash of bytes.

use std::fmt::{self, Write};

const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// Computes the 64-bit FNV-1a hash of `bytes`, continuing from the hash `before`, which is 0 at first.
pub fn digest(before: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(before ^ OFFSET, step)
}

fn step(value: u64, &byte: &u8) -> u64 {
    (value ^ u64::from(byte)).wrapping_mul(PRIME)
}

/// Computes the hash of a formatted text without storing the text.
pub fn digest_of(text: fmt::Arguments) -> u64 {
    let mut digest = TextDigest(OFFSET);
    // The digest takes any text.
    let _ = digest.write_fmt(text);
    digest.0
}

struct TextDigest(u64);

impl Write for TextDigest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = text.as_bytes().iter().fold(self.0, step);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_published_function() {
        assert_eq!(digest(0, b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(digest(0, b"foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(digest_of(format_args!("{}{}", "foo", "bar")), digest(0, b"foobar"));
    }
}
