//! The last samples of a waveform as packed bits, with hashes of any number of them.

use tofsim::error::Result;

use super::super::super::plan::Plan;
use super::super::correlation::{PairBits, SearchEnd};
use super::needle::packed;

/// What hashes are powers of.
const BASE: u64 = 0x9e37_79b9_7f4a_7c15;

/// The last samples.
pub(super) struct Hay {
    rows: Vec<u64>,
    stride: usize,
    /// Hash of all samples up to each, and before the first.
    hashes: Vec<u64>,
    /// Number of the first sample that is here, and of the first there was.
    begin: u64,
    first: u64,
    /// Samples that are kept.
    longest: usize,
    /// How many samples are like the one before them, up to the last.
    pub(super) steady: usize,
}

impl Hay {
    fn push(&mut self, row: &[u64]) {
        let count = self.hashes.len() - 1;
        let before = self.rows.len().checked_sub(self.stride).map(|begin| &self.rows[begin..]);
        self.steady = if before == Some(row) { self.steady + 1 } else { 0 };
        self.rows.extend_from_slice(row);
        let hash = self.hashes[count].wrapping_mul(BASE).wrapping_add(mixed(row));
        self.hashes.push(hash);
        if count > 4 * self.longest + 1024 {
            let gone = count - self.longest;
            self.rows.drain(..gone * self.stride);
            self.hashes.drain(..gone);
            self.begin += gone as u64;
        }
    }

    /// The number of the last sample.
    pub(super) fn last(&self) -> u64 {
        self.begin + self.hashes.len() as u64 - 2
    }

    /// The number of the first of `length` samples of which the last is `end`, if there are so many.
    pub(super) fn first_of(&self, end: u64, length: usize) -> Option<u64> {
        (end + 1).checked_sub(length as u64).filter(|&first| first >= self.first)
    }

    /// So many samples from `first` on, of those kept.
    pub(super) fn samples(&self, first: u64, length: usize) -> &[u64] {
        let begin = (first - self.begin) as usize * self.stride;
        &self.rows[begin..begin + length * self.stride]
    }

    /// The hash of the last `length` samples, where `power` is that of the base.
    pub(super) fn hash(&self, length: usize, power: u64) -> Option<u64> {
        let last = self.hashes.len() - 1;
        let before = self.hashes[last.checked_sub(length)?];
        Some(self.hashes[last].wrapping_sub(before.wrapping_mul(power)))
    }
}

/// The hash of some samples, as that of a waveform's last.
pub(super) fn hash(rows: &[u64], stride: usize) -> u64 {
    let rows = rows.chunks_exact(stride);
    rows.fold(0u64, |hash, row| hash.wrapping_mul(BASE).wrapping_add(mixed(row)))
}

/// The power of the base that goes with so many samples.
pub(super) fn power(length: usize) -> u64 {
    BASE.wrapping_pow(length as u32)
}

fn mixed(row: &[u64]) -> u64 {
    let mix = |hash: u64, word: &u64| {
        let hash = (hash ^ word).wrapping_mul(0xff51_afd7_ed55_8ccd);
        hash ^ hash >> 32
    };
    row.iter().fold(1, mix)
}

/// Passes over a waveform; `seen` gets the last samples, `longest` of them at least, for each.
pub(super) fn pass(
    plan: &Plan,
    side: usize,
    bits: &mut PairBits,
    longest: usize,
    mut seen: impl FnMut(&Hay),
) -> Result<()> {
    let stride = 2 * bits.width.div_ceil(64);
    let (rows, hashes) = (Vec::new(), vec![0]);
    let mut hay = Hay { rows, stride, hashes, begin: 0, first: 0, longest, steady: 0 };
    let mut samples = plan.samples(side)?;
    let mut row = None;
    let mut end = SearchEnd::new(plan, side, longest)?;
    while let Some(sample) = samples.next()?.filter(|&sample| !sample.held && end.takes(sample)) {
        let mut changed = false;
        samples.changes(|_| changed = true);
        if !plan.is_looked_at(side, sample) {
            continue;
        }
        if row.is_none() {
            (hay.begin, hay.first) = (sample.index, sample.index);
        }
        let now = match row {
            Some(row) if !changed => row,
            _ => packed(&bits.row(side, &samples.state)),
        };
        hay.push(&now);
        row = Some(now);
        seen(&hay);
    }
    Ok(())
}
