//! Rolling window over a waveform's samples as packed bits, with hashes of any number of them.

use tofsim::error::Result;

use super::super::super::plan::Plan;
use super::super::correlation::{PairBits, SearchEnd};
use super::template::packed;

/// Base of the polynomial hash.
const BASE: u64 = 0x9e37_79b9_7f4a_7c15;

/// The most recent samples of a waveform.
pub(super) struct RecentSamples {
    rows: Vec<u64>,
    stride: usize,
    /// Hash of all samples up to each, preceded by the hash of none.
    hashes: Vec<u64>,
    /// Numbers of the first sample kept, and of the first sample of all.
    begin: u64,
    first: u64,
    /// Number of samples to keep.
    longest: usize,
    /// Number of samples, up to the last, that equal their predecessor.
    pub(super) steady: usize,
}

impl RecentSamples {
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

    /// Returns the number of the last sample.
    pub(super) fn last(&self) -> u64 {
        self.begin + self.hashes.len() as u64 - 2
    }

    /// Returns the number of the first of `length` samples that end with sample `end`, if there are as many.
    pub(super) fn first_of(&self, end: u64, length: usize) -> Option<u64> {
        (end + 1).checked_sub(length as u64).filter(|&first| first >= self.first)
    }

    /// Returns `length` samples from `first` on, which must be kept.
    pub(super) fn samples(&self, first: u64, length: usize) -> &[u64] {
        let begin = (first - self.begin) as usize * self.stride;
        &self.rows[begin..begin + length * self.stride]
    }

    /// Returns the hash of the last `length` samples, where `power` is the base to the power of `length`.
    pub(super) fn hash(&self, length: usize, power: u64) -> Option<u64> {
        let last = self.hashes.len() - 1;
        let before = self.hashes[last.checked_sub(length)?];
        Some(self.hashes[last].wrapping_sub(before.wrapping_mul(power)))
    }
}

/// Computes the hash of some samples.
pub(super) fn hash(rows: &[u64], stride: usize) -> u64 {
    let rows = rows.chunks_exact(stride);
    rows.fold(0u64, |hash, row| hash.wrapping_mul(BASE).wrapping_add(mixed(row)))
}

/// Returns the base to the power of `length`.
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

/// Reads a waveform, and calls `seen` at each sample with at least the `longest` most recent samples.
pub(super) fn pass(
    plan: &Plan,
    side: usize,
    bits: &mut PairBits,
    longest: usize,
    mut seen: impl FnMut(&RecentSamples),
) -> Result<()> {
    let stride = 2 * bits.width.div_ceil(64);
    let (rows, hashes) = (Vec::new(), vec![0]);
    let mut recent = RecentSamples { rows, stride, hashes, begin: 0, first: 0, longest, steady: 0 };
    let mut samples = plan.samples(side)?;
    let mut row = None;
    let mut end = SearchEnd::new(plan, side, longest)?;
    while let Some(sample) =
        samples.next()?.filter(|&sample| !sample.is_extended && end.takes(sample))
    {
        let mut changed = false;
        samples.changes(|_| changed = true);
        if !plan.is_looked_at(side, sample) {
            continue;
        }
        if row.is_none() {
            (recent.begin, recent.first) = (sample.index, sample.index);
        }
        let now = match row {
            Some(row) if !changed => row,
            _ => packed(&bits.row(side, &samples.state)),
        };
        recent.push(&now);
        row = Some(now);
        seen(&recent);
    }
    Ok(())
}
