//! Peaks of a sampled curve, as MATLAB's `findpeaks` has them.
//!
//! A peak is a sample, or a run of equal ones, above both neighbours; its place is the first sample
//! of the run, and the ends of the curve are none. The prominence is its height above the higher of
//! two valleys: the lowest samples on either side, as far as the first higher peak or the end.
//!
//! The width is that of `WidthReference = 'halfheight'` (thesis Table 5.1): between the two crossings
//! of half the height above zero, interpolated linearly, and no further than the lowest valley
//! between two peaks. Valleys are looked for as far as the first peak that is as high, and only peaks
//! that are prominent enough border one another. Peaks that are not above zero have no half height
//! and are dropped first, as there.

/// Criteria of a peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// `MinPeakProminence` [unit of the ordinate].
    pub min_prominence: f64,
    /// `MaxPeakWidth` at half height [unit of the abscissa].
    pub max_width: f64,
}

/// A peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Sample.
    pub index: usize,
    /// Abscissa there.
    pub location: f64,
    /// Ordinate there.
    pub height: f64,
    /// Width at half height [unit of the abscissa].
    pub width: f64,
    /// Prominence [unit of the ordinate].
    pub prominence: f64,
}

/// The peaks of the curve (`x[k]`, `y[k]`), from left to right; of unequal lengths the shorter counts.
pub fn findpeaks(x: &[f64], y: &[f64], criteria: &Criteria) -> Vec<Peak> {
    let curve = Curve::new(x, y);
    let mut found: Vec<_> = curve.peaks().map(|run| curve.survey(run)).collect();
    found.retain(|peak| peak.prominence >= criteria.min_prominence);
    let peaks = (0..found.len()).map(|k| {
        let Found { index, prominence, .. } = found[k];
        let width = curve.width(index, borders(&found, k));
        Peak { index, location: curve.x[index], height: curve.y[index], width, prominence }
    });
    peaks.filter(|peak| peak.width <= criteria.max_width).collect()
}

/// Returns the borders of a peak's width: its saddles, or those of its neighbours if these are nearer and on the
/// right side of the peak.
fn borders(found: &[Found], k: usize) -> [usize; 2] {
    let Found { index, saddles: [mut left, mut right], .. } = found[k];
    if let Some(before) = found[..k].last().filter(|before| before.saddles[1] <= index) {
        left = left.max(before.saddles[1]);
    }
    if let Some(after) = found.get(k + 1).filter(|after| after.saddles[0] >= index) {
        right = right.min(after.saddles[0]);
    }
    [left, right]
}

/// The curve, and where its runs of equal samples begin.
struct Curve<'a> {
    x: &'a [f64],
    y: &'a [f64],
    runs: Vec<usize>,
}

/// A peak before it has a width.
#[derive(Clone, Copy)]
struct Found {
    index: usize,
    prominence: f64,
    /// Lowest samples as far as the first peak that is as high, left and right.
    saddles: [usize; 2],
}

impl<'a> Curve<'a> {
    fn new(x: &'a [f64], y: &'a [f64]) -> Self {
        let length = x.len().min(y.len());
        let (x, y) = (&x[..length], &y[..length]);
        let runs = (0..length).filter(|&k| k == 0 || y[k] != y[k - 1]).collect();
        Curve { x, y, runs }
    }

    /// Places in `runs` of the peaks above zero.
    fn peaks(&self) -> impl Iterator<Item = usize> {
        let heights = |run: usize| [run - 1, run, run + 1].map(|run| self.y[self.runs[run]]);
        (1..self.runs.len().saturating_sub(1)).filter(move |&run| {
            let [before, height, after] = heights(run);
            before < height && height > after && height > 0.0
        })
    }

    /// Prominence and saddles of the peak at a run.
    fn survey(&self, run: usize) -> Found {
        let index = self.runs[run];
        let left = self.valleys(index, self.runs[..run].iter().rev());
        let right = self.valleys(index, self.runs[run + 1..].iter());
        let base = self.y[left[0]].max(self.y[right[0]]);
        Found { index, prominence: self.y[index] - base, saddles: [left[1], right[1]] }
    }

    /// The lowest sample before a higher one, and the lowest before one as high.
    fn valleys<'r>(&self, peak: usize, outward: impl Iterator<Item = &'r usize>) -> [usize; 2] {
        let (mut lowest, mut saddle) = (peak, None);
        for &index in outward {
            if self.y[index] >= self.y[peak] {
                saddle.get_or_insert(lowest);
                if self.y[index] > self.y[peak] {
                    break;
                }
            }
            if self.y[index] < self.y[lowest] {
                lowest = index;
            }
        }
        [lowest, saddle.unwrap_or(lowest)]
    }

    /// Width at half height, no further than the borders.
    fn width(&self, peak: usize, [left, right]: [usize; 2]) -> f64 {
        let half = self.y[peak] / 2.0;
        let below = |index: &usize| self.y[*index] <= half;
        let crossing = |under: usize, over: usize| {
            let part = (half - self.y[under]) / (self.y[over] - self.y[under]);
            self.x[under] + (self.x[over] - self.x[under]) * part
        };
        let from = match (left..peak).rev().find(below) {
            Some(under) => crossing(under, under + 1),
            None => self.x[left],
        };
        let until = match (peak + 1..=right).find(below) {
            Some(under) => crossing(under, under - 1),
            None => self.x[right],
        };
        until - from
    }
}

#[cfg(test)]
mod tests;
