//! Text in a VCD that means nothing: `$comment`, `$date` and `$version` up to their `$end`.

/// Commands whose text may be anything.
const REMARKS: [&[u8]; 3] = [b"$comment", b"$date", b"$version"];
/// What ends them.
const END: &[u8] = b"$end";
/// Bytes by which they are known.
const HEAD: usize = 8;

/// A command that began at the begin of a line.
#[derive(Clone, Debug, Default)]
pub(super) struct Remark {
    head: Vec<u8>,
    /// Bytes of the `$end` under way.
    matched: usize,
    ended: bool,
}

impl Remark {
    /// Takes the next bytes of the line.
    pub(super) fn take(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if self.head.len() < HEAD {
                self.head.push(byte);
            }
            self.matched = match byte == END[self.matched] {
                true => self.matched + 1,
                false => usize::from(byte == END[0]),
            };
            if self.matched == END.len() {
                self.ended = true;
                self.matched = 0;
            }
        }
    }

    /// Whether it goes on after the end of a line.
    pub(super) fn goes_on(&self) -> bool {
        !self.ended && REMARKS.iter().any(|word| self.head.starts_with(word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remark_goes_on_until_its_end() {
        let goes_on = |text: &str| {
            let mut remark = Remark::default();
            text.as_bytes().chunks(3).for_each(|bytes| remark.take(bytes));
            remark.goes_on()
        };
        assert!(goes_on("$comment\n#5 $en d"));
        assert!(!goes_on("$comment #5 $$end"));
        assert!(goes_on("$date\n"));
        assert!(!goes_on("$dumpvars\n"));
    }
}
