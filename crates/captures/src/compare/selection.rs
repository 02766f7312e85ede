//! Selection of samples by windows.

use tofsim::error::Result;

use super::samples::{Sample, Samples};

/// Samples of a window, in ascending order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    /// Consecutive samples from a first one on; their number, or `None` for all that follow.
    Run(u64, Option<u64>),
    /// Listed samples.
    Kept(Vec<u64>),
}

impl Piece {
    /// Returns the number of the sample at `position`, if there is one.
    pub(super) fn sample(&self, position: u64) -> Option<u64> {
        match self {
            Piece::Run(first, count) => {
                count.is_none_or(|count| position < count).then(|| first + position)
            }
            Piece::Kept(samples) => samples.get(position as usize).copied(),
        }
    }

    /// Returns the number of samples, if it is known.
    pub(super) fn count(&self) -> Option<u64> {
        match self {
            Piece::Run(_, count) => *count,
            Piece::Kept(samples) => Some(samples.len() as u64),
        }
    }

    /// Returns the part from `position` on, with at most `count` samples.
    pub(super) fn part(&self, position: u64, count: u64) -> Piece {
        match self {
            Piece::Run(first, all) => {
                let left = all.map_or(count, |all| all.saturating_sub(position).min(count));
                Piece::Run(first + position, Some(left))
            }
            Piece::Kept(samples) => {
                let chosen = samples.iter().skip(position as usize).take(count as usize);
                Piece::Kept(chosen.copied().collect())
            }
        }
    }
}

/// Reader of those samples of a sequence that belong to pieces.
pub(super) struct Selected<'a> {
    pub(super) samples: Samples,
    pieces: &'a [Piece],
    piece: usize,
    position: u64,
}

/// A sample, and its place among the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SamplePlace {
    /// Index of the piece, that is, of the window.
    pub(super) piece: usize,
    /// Position within the piece.
    pub(super) position: u64,
    pub(super) sample: Sample,
}

impl<'a> Selected<'a> {
    /// Creates a reader of the pieces of `samples`.
    pub(super) fn new(samples: Samples, pieces: &'a [Piece]) -> Self {
        Selected { samples, pieces, piece: 0, position: 0 }
    }

    /// Reads the next sample of the piece; returns `None` at its end.
    pub(super) fn next(&mut self) -> Result<Option<SamplePlace>> {
        let wanted = self.pieces.get(self.piece).and_then(|piece| piece.sample(self.position));
        let Some(wanted) = wanted else { return Ok(None) };
        while let Some(sample) = self.samples.next()? {
            if sample.index == wanted {
                let place = SamplePlace { piece: self.piece, position: self.position, sample };
                self.position += 1;
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    /// Moves to the next piece; returns `false` if there is none.
    pub(super) fn next_piece(&mut self) -> bool {
        self.piece += 1;
        self.position = 0;
        self.piece < self.pieces.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_piece_begins_where_asked() {
        assert_eq!(Piece::Run(10, None).part(5, 3), Piece::Run(15, Some(3)));
        assert_eq!(Piece::Run(10, Some(7)).part(5, 3), Piece::Run(15, Some(2)));
        assert_eq!(Piece::Run(10, Some(4)).part(5, 3), Piece::Run(15, Some(0)));
        assert_eq!(Piece::Kept(vec![1, 4, 9, 16]).part(1, 2), Piece::Kept(vec![4, 9]));
    }
}
