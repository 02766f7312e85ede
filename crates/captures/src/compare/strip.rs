//! A line that shows where something lies in a range whose end is not known before.

/// Characters of a line.
const LENGTH: usize = 64;

/// Marks in equal parts of a range; the parts grow as the range does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Strip {
    marks: [u64; LENGTH],
    /// Logarithm of a part's size.
    scale: u32,
}

impl Default for Strip {
    fn default() -> Self {
        Strip { marks: [0; LENGTH], scale: 0 }
    }
}

impl Strip {
    /// Something lies at `place`.
    pub(super) fn mark(&mut self, place: u64) {
        while (place >> self.scale) >= LENGTH as u64 {
            self.coarsen();
        }
        self.marks[(place >> self.scale) as usize] += 1;
    }

    fn coarsen(&mut self) {
        for k in 0..LENGTH / 2 {
            self.marks[k] = self.marks[2 * k] + self.marks[2 * k + 1];
        }
        self.marks[LENGTH / 2..].fill(0);
        self.scale += 1;
    }

    /// The line for a range of `length`: `#` where something lies, `.` elsewhere.
    pub(super) fn text(&self, length: u64) -> String {
        let mut strip = self.clone();
        while (length.saturating_sub(1) >> strip.scale) >= LENGTH as u64 {
            strip.coarsen();
        }
        let parts = (length.saturating_sub(1) >> strip.scale) as usize + 1;
        strip.marks[..parts].iter().map(|&count| if count > 0 { '#' } else { '.' }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_grows_coarser_as_the_range_grows() {
        let mut strip = Strip::default();
        strip.mark(3);
        strip.mark(60);
        assert_eq!(strip.text(64).matches('#').count(), 2);
        assert_eq!(strip.text(8), "...#....");
        strip.mark(127);
        let text = strip.text(128);
        assert_eq!((text.len(), text.find('#'), text.rfind('#')), (64, Some(1), Some(63)));
        assert_eq!(strip.text(1024).len(), 64);
        assert_eq!(Strip::default().text(0), ".");
    }
}
