//! A window as packed bits, with its best positions in a waveform.

use super::super::correlation::{Candidate, KEPT};

/// Number of sections by which a window is located.
const SEEDS: usize = 16;

/// A window with its best positions.
pub(super) struct Template {
    /// Packed bits of its samples.
    rows: Vec<u64>,
    /// Words per sample.
    stride: usize,
    /// Order in which samples are compared: those at which something changes come first, because they differ from
    /// most of the waveform.
    order: Vec<usize>,
    /// Best positions with twice their number of differing bits, best first.
    best: Vec<(u64, u64)>,
    /// Number of differing half bits below which all positions have been compared.
    sure: u64,
}

impl Template {
    /// Creates a window from samples of `stride` words.
    pub(super) fn new(rows: Vec<u64>, stride: usize) -> Template {
        let row = |k: usize| &rows[k * stride..(k + 1) * stride];
        let changes = |&k: &usize| k > 0 && row(k) != row(k - 1);
        let (first, last): (Vec<_>, Vec<_>) = (0..rows.len() / stride).partition(changes);
        Template { order: [first, last].concat(), rows, stride, best: Vec::new(), sure: 0 }
    }

    /// Returns the number of samples.
    pub(super) fn length(&self) -> usize {
        self.order.len()
    }

    /// Returns sections in which something changes, each with the number of samples after it. Fewer differences than
    /// there are such sections leave at least one of them intact.
    pub(super) fn seeds(&mut self) -> Vec<(&[u64], usize)> {
        let (length, stride) = (self.length(), self.stride);
        let part = (length / SEEDS).max(1) * stride;
        let parts = self.rows.chunks_exact(part).enumerate();
        let changes = |rows: &[u64]| rows.chunks_exact(stride).any(|row| *row != rows[..stride]);
        let seeds: Vec<_> = parts
            .filter(|(_, rows)| changes(rows))
            .map(|(k, rows)| (rows, length - (k + 1) * part / stride))
            .collect();
        self.sure = seeds.len() as u64;
        seeds
    }

    /// Restarts the search, with all positions to be compared.
    pub(super) fn begin_anew(&mut self) {
        self.best.clear();
        self.sure = u64::MAX;
    }

    /// Compares the window with samples at position `first`, and keeps it if it is one of the best.
    pub(super) fn lay_over(&mut self, samples: &[u64], first: u64) {
        let worst = self.best.get(KEPT - 1).map_or(u64::MAX, |&(_, worst)| worst);
        let (stride, mut differing) = (self.stride, 0);
        for &k in &self.order {
            let place = k * stride..(k + 1) * stride;
            differing += distance(&self.rows[place.clone()], &samples[place]);
            if differing >= worst {
                return;
            }
        }
        let place = self.best.partition_point(|&(_, other)| other <= differing);
        self.best.insert(place, (first, differing));
        self.best.truncate(KEPT);
    }

    /// Returns the best positions from `from` on; `None` if unknown positions may be as good.
    ///
    /// Positions before `from` are included too, unless they are nearly as good.
    pub(super) fn candidates(&self, from: u64, width: usize) -> Option<Vec<Candidate>> {
        let &(_, best) = self.best.iter().find(|(first, _)| *first >= from)?;
        let dropped = self.best.get(KEPT - 1).map_or(u64::MAX, |&(_, worst)| worst);
        if 2 * best >= dropped.min(self.sure) {
            return None;
        }
        let compared = (self.length() * width) as u64;
        let kept = self.best.iter().filter(|(first, twice)| *first >= from || *twice > 2 * best);
        let candidate = |&(first, twice): &(u64, u64)| Candidate {
            offset: first as i64,
            differing: twice.div_ceil(2),
            compared,
        };
        Some(kept.map(candidate).collect())
    }
}

/// Returns twice the number of differing bits; a bit that is unknown on one side counts half.
#[inline]
fn distance(a: &[u64], b: &[u64]) -> u64 {
    let half = a.len() / 2;
    let words = (0..half).map(|k| {
        let unknown = a[half + k] | b[half + k];
        let differs = (a[k] ^ b[k]) & !unknown;
        u64::from(2 * differs.count_ones() + unknown.count_ones())
    });
    words.sum()
}

/// Packs the bits of a sample: words of values, then words of unknown bits.
pub(super) fn packed(bits: &[i8]) -> Vec<u64> {
    let words = bits.len().div_ceil(64);
    let mut row = vec![0; 2 * words];
    for (k, bit) in bits.iter().enumerate() {
        row[k / 64] |= u64::from(*bit > 0) << (k % 64);
        row[words + k / 64] |= u64::from(*bit == 0) << (k % 64);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_that_are_unknown_differ_by_half() {
        let (a, b) = (packed(&[1, -1, 0, 1]), packed(&[1, 1, 1, 0]));
        assert_eq!(distance(&a, &b), 2 + 1 + 1);
        assert_eq!(distance(&a, &a), 1);
        assert_eq!(distance(&packed(&[1; 70]), &packed(&[-1; 70])), 140);
    }

    /// Returns samples of two bits.
    fn rows(values: &[u8]) -> Vec<u64> {
        let bit = |value: u8, k: u8| (value >> k & 1) as i8 * 2 - 1;
        values.iter().flat_map(|&value| packed(&[bit(value, 0), bit(value, 1)])).collect()
    }

    #[test]
    fn a_window_keeps_the_places_where_it_fits_best() {
        let mut template = Template::new(rows(&[0, 3, 1]), 2);
        let wave = rows(&[0, 0, 3, 1, 2, 0, 3, 3]);
        template.begin_anew();
        (0..6).for_each(|first| template.lay_over(&wave[2 * first..][..6], first as u64));
        let kept = |from: u64| {
            let candidates = template.candidates(from, 2).unwrap();
            candidates.iter().map(|c| (c.offset, c.differing)).collect::<Vec<_>>()
        };
        assert_eq!(kept(0)[..2], [(1, 0), (5, 1)]);
        assert_eq!(kept(2)[0], (5, 1));
        assert!(template.candidates(6, 2).is_none());
    }

    #[test]
    fn what_differs_in_as_many_places_as_there_are_seeds_is_not_sure() {
        let mut template = Template::new(rows(&[0, 1].repeat(32)), 2);
        let seeds: Vec<_> =
            template.seeds().iter().map(|(rows, behind)| (rows.len(), *behind)).collect();
        assert_eq!((seeds.len(), seeds[0], seeds[15]), (16, (8, 60), (8, 0)));
        let mut other = [0, 1].repeat(32);
        for (k, is_sure) in [(3, true), (9, true), (11, true), (20, false)] {
            other[k] ^= 1;
            template.best.clear();
            template.lay_over(&rows(&other), 5);
            assert_eq!(template.candidates(0, 2).is_some(), is_sure, "{k}");
        }
    }
}
