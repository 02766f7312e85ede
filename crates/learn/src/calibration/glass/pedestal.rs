//! Where the pedestal is, and the ambient light beside it.

use std::ops::Range;

use tofsim::error::{Input, Result};

use crate::estimation::acquisition::{ARRIVAL_PS_PER_M, Acquisition};

use super::cells::{Cells, SOURCE};

/// Excess of hits in a box beyond ambient light that begins a pedestal or an echo [sigma].
pub const SURE: f64 = 5.0;
/// Excess beyond which a box next to it is part of it [sigma].
const PART: f64 = 2.0;
/// Distance beyond which no cover window is expected [m].
pub const FARTHEST_M: f64 = 0.1;
/// Rounds in which the bins outside of pedestal and echoes are found.
const ROUNDS: usize = 20;

/// Ambient light and dark counts, at a constant rate.
#[derive(Clone, Copy, Debug)]
pub struct Ambient {
    /// Rate [1/ps].
    pub rate: f64,
    /// Standard error of the rate [1/ps].
    pub rate_se: f64,
}

impl Ambient {
    /// The rate in the bins where no box has an excess, from the median of the boxes on.
    pub fn fit(cells: &Cells) -> Self {
        let mut rates: Vec<_> = cells
            .boxes()
            .step_by(cells.box_bins)
            .map(|bins| Ambient::of(cells, bins).rate)
            .collect();
        rates.sort_by(f64::total_cmp);
        let mut ambient = Ambient { rate: rates[rates.len() / 2], rate_se: 0.0 };
        for _ in 0..ROUNDS {
            let mut is_free = vec![true; cells.hits.len()];
            for bins in cells.boxes().filter(|bins| ambient.excess(cells, bins) > PART) {
                is_free[bins].fill(false);
            }
            let next = Ambient::of(cells, (0..is_free.len()).filter(|&bin| is_free[bin]));
            if next.rate_se == 0.0 || next.rate == ambient.rate {
                break;
            }
            ambient = next;
        }
        ambient
    }

    /// The rate of hits in bins.
    pub fn of(cells: &Cells, bins: impl Iterator<Item = usize>) -> Self {
        let (mut hits, mut exposed) = (0.0, 0.0);
        for bin in bins {
            hits += cells.hits[bin];
            exposed += (cells.waiting[bin] - 0.5 * cells.hits[bin]) * cells.widths_ps[bin];
        }
        if exposed <= 0.0 {
            return Ambient { rate: 0.0, rate_se: 0.0 };
        }
        Ambient { rate: hits / exposed, rate_se: hits.max(1.0).sqrt() / exposed }
    }

    /// Hits of ambient light in a bin [hits].
    fn hits(&self, cells: &Cells, bin: usize) -> f64 {
        -cells.waiting[bin] * libm::expm1(-self.rate * cells.widths_ps[bin])
    }

    /// Hits of a box beyond those of ambient light [sigma].
    pub fn excess(&self, cells: &Cells, bins: &Range<usize>) -> f64 {
        let found: f64 = cells.hits[bins.clone()].iter().sum();
        let expected: f64 = bins.clone().map(|bin| self.hits(cells, bin)).sum();
        (found - expected) / expected.max(1.0).sqrt()
    }
}

/// Returns the bins of the pedestal: the first boxes with more hits than ambient light has.
///
/// # Errors
/// When there are none, or they are where no window is.
pub fn support(
    acquisition: &Acquisition,
    cells: &Cells,
    ambient: &Ambient,
) -> Result<Range<usize>> {
    let boxes: Vec<_> = cells.boxes().collect();
    let excess = |place: &usize| ambient.excess(cells, &boxes[*place]);
    let Some(first) = (0..boxes.len()).find(|place| excess(place) > SURE) else {
        let expected = "expected light of a cover window, five standard deviations above the ambient light: take \
                        more histograms, or do without a template";
        return Err(Input::new(SOURCE, expected).field("pedestal").value("none").into());
    };
    let past = (first..boxes.len()).find(|place| excess(place) <= PART).unwrap_or(boxes.len());
    let rate = |place: &usize| Ambient::of(cells, boxes[*place].clone()).rate;
    let peak = (first..past).max_by(|a, b| rate(a).total_cmp(&rate(b))).unwrap_or(first);
    let at_m = (cells.middle_ps(&boxes[peak]) - acquisition.delay_ps) / ARRIVAL_PS_PER_M;
    if at_m > FARTHEST_M {
        let expected = format!(
            "a target at {} is all that stands out: expected the light of a cover window within {FARTHEST_M} m",
            metres(at_m)
        );
        return Err(Input::new(SOURCE, expected).field("histograms").value("all").into());
    }
    // A pedestal begins at its rise, however many boxes before it the first one with an excess reaches.
    let begin = (0..first).rev().find(|place| excess(place) <= PART).map_or(0, |place| place + 1);
    Ok(boxes[begin].start..boxes[past - 1].end)
}

/// A distance in an error.
pub fn metres(at_m: f64) -> String {
    format!("{at_m:.3} m")
}
