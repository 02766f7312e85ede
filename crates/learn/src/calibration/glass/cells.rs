//! Bins of a calibration, with the hits of all histograms and the hazards that they show.

use std::ops::Range;

use tofsim::network::Histogram;

use crate::estimation::acquisition::{Acquisition, spans_ps};

/// Name of the calibration in errors.
pub const SOURCE: &str = "calibrate glass";

/// Bins in order of time, with the hits of all histograms.
#[derive(Clone, Debug)]
pub struct Cells {
    /// Code, begin and end [code, ps].
    pub limits: Vec<(usize, [f64; 2])>,
    /// Width, without gaps that have another code or none [ps].
    pub widths_ps: Vec<f64>,
    /// Hits [hits].
    pub hits: Vec<f64>,
    /// Shots that wait at the begin of each bin [shots].
    pub waiting: Vec<f64>,
    /// Bins of two standard deviations of the pulse: a box in which an echo is looked for.
    pub box_bins: usize,
}

impl Cells {
    /// Of the histograms together, in bins of which each has one begin and one end.
    pub fn new(acquisition: &Acquisition, histograms: &[Histogram]) -> Self {
        let mut limits: Vec<(usize, [f64; 2])> = Vec::new();
        let mut widths_ps: Vec<f64> = Vec::new();
        for (code, from_ps, until_ps) in spans_ps(acquisition.bins) {
            match limits.iter().position(|(known, _)| *known == usize::from(code)) {
                Some(known) => {
                    limits[known].1[1] = until_ps;
                    widths_ps[known] += until_ps - from_ps;
                }
                None => {
                    limits.push((code.into(), [from_ps, until_ps]));
                    widths_ps.push(until_ps - from_ps);
                }
            }
        }
        let count = |code: usize| histograms.iter().map(|one| u64::from(one[code])).sum::<u64>();
        let hits: Vec<_> = limits.iter().map(|&(code, _)| count(code) as f64).collect();
        let shots = histograms.len() as f64 * acquisition.shots as f64;
        let waiting = waiting(shots, &hits);
        let box_ps = 2.0 * acquisition.pulse.sigma_ps();
        let box_bins = (box_ps / acquisition.bins.bin_ps()).round().max(1.0) as usize;
        let box_bins = box_bins.min(limits.len());
        Cells { limits, widths_ps, hits, waiting, box_bins }
    }

    /// Hazard of a bin and its variance, with ambient light [1].
    pub fn hazard(&self, bin: usize) -> [f64; 2] {
        let (had, left) = (self.waiting[bin], self.waiting[bin] - self.hits[bin]);
        if left <= 0.0 {
            return [0.0; 2];
        }
        [libm::log(had / left), (had - left) / (had * left)]
    }

    /// Boxes, by their first bin.
    pub fn boxes(&self) -> impl Iterator<Item = Range<usize>> {
        self.boxes_of(self.box_bins)
    }

    /// Boxes of so many bins.
    pub fn boxes_of(&self, length: usize) -> impl Iterator<Item = Range<usize>> {
        (0..=self.limits.len() - length).map(move |from| from..from + length)
    }

    /// Middle of a box [ps].
    pub fn middle_ps(&self, bins: &Range<usize>) -> f64 {
        0.5 * (self.limits[bins.start].1[0] + self.limits[bins.end - 1].1[1])
    }
}

/// Shots that wait at the begin of each bin.
pub fn waiting(shots: f64, hits: &[f64]) -> Vec<f64> {
    let next = |left: &mut f64, hits: &f64| {
        let now = *left;
        *left -= hits;
        Some(now)
    };
    hits.iter().scan(shots, next).collect()
}
