//! Targets in histograms that should have none, and pedestals that differ.
//!
//! A window's light rises and falls once. A box whose rate is above that of an earlier one after the peak is an echo. So
//! is one that stands out in one histogram among the others.

use std::ops::Range;

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;

use crate::estimation::acquisition::{ARRIVAL_PS_PER_M, Acquisition};

use super::cells::{Cells, waiting};
use super::pedestal::{Ambient, SURE, metres};

/// Part of the rate by which boxes of even light differ, because widths of bins are not known better [1].
const UNEVEN: f64 = 0.03;
/// Difference of one histogram from all that chance does not make in any box of a thousand histograms [sigma].
const ODD: f64 = 6.0;
/// Hits that are added to the variance of a box, so that a few in the dark do not stand out [hits].
const FEW: f64 = 4.0;

/// Checks that all histograms show the same pedestal and no target.
///
/// # Errors
/// The histogram and the place where there is more.
pub fn check(
    acquisition: &Acquisition,
    cells: &Cells,
    ambient: &Ambient,
    support: &Range<usize>,
    histograms: &[Histogram],
    name: &impl Fn(usize) -> (String, usize),
) -> Result<()> {
    // Short boxes show the dip before a near echo, long ones a faint echo.
    let lengths = [cells.box_bins, cells.box_bins.div_ceil(2)];
    let found = lengths.iter().find_map(|&length| second_rise(cells, ambient, length));
    let found = found.map(|bins| {
        let hits = |one: &Histogram| hits(cells, one, &bins) as u64;
        let most = (0..histograms.len()).max_by_key(|&k| hits(&histograms[k])).unwrap_or(0);
        (most, bins, "in all histograms together")
    });
    let odd = || odd_one(acquisition, cells, histograms);
    let Some((number, bins, who)) = found.or_else(odd) else { return Ok(()) };
    let at_m = (cells.middle_ps(&bins) - acquisition.delay_ps) / ARRIVAL_PS_PER_M;
    let (source, own) = name(number);
    let is_pedestal = bins.start < support.end && who == ALONE;
    let expected = if is_pedestal {
        format!(
            "at {} it differs from the other histograms by more than chance: expected the same light of the cover \
             window and no target in all",
            metres(at_m)
        )
    } else {
        format!(
            "a target at {} stands out {who}: expected nothing in front of the cover window",
            metres(at_m)
        )
    };
    Err(Input::new(source, expected).field("histogram").value(own).into())
}

const ALONE: &str = "in this histogram";

/// The box of so many bins with the clearest rise after the pedestal's peak.
fn second_rise(cells: &Cells, ambient: &Ambient, length: usize) -> Option<Range<usize>> {
    // All light before the laser edge comes with it, which is a peak by itself.
    let is_later = |bins: &Range<usize>| cells.limits[bins.start].1[0] > 0.0;
    let boxes: Vec<_> = cells.boxes_of(length).filter(is_later).collect();
    let rates: Vec<_> = boxes.iter().map(|bins| Ambient::of(cells, bins.clone())).collect();
    let first = (0..boxes.len()).find(|&place| ambient.excess(cells, &boxes[place]) > SURE)?;
    // The peak of the pedestal: where the rate first falls by more than chance.
    let is_below = |a: &Ambient, b: &Ambient| rise(a, b) > SURE;
    let mut peak = first;
    let mut place = first;
    while place < boxes.len() && !is_below(&rates[place], &rates[peak]) {
        if rates[place].rate > rates[peak].rate {
            peak = place;
        }
        place += 1;
    }
    let mut least = *rates.get(place)?;
    let mut best: Option<(f64, usize)> = None;
    for (later, rate) in rates.iter().enumerate().skip(place) {
        let floor = if least.rate > ambient.rate { &least } else { ambient };
        let found = rise(floor, rate);
        if found > SURE && best.is_none_or(|(most, _)| found > most) {
            best = Some((found, later));
        }
        if rate.rate < least.rate {
            least = *rate;
        }
    }
    best.map(|(_, place)| boxes[place].clone())
}

/// Returns by how much one rate is above another [sigma].
fn rise(from: &Ambient, to: &Ambient) -> f64 {
    let error = from.rate_se.hypot(to.rate_se).hypot(UNEVEN * from.rate);
    (to.rate - from.rate) / error
}

fn hits(cells: &Cells, histogram: &Histogram, bins: &Range<usize>) -> f64 {
    let codes = cells.limits[bins.clone()].iter();
    codes.map(|&(code, _)| f64::from(histogram[code])).sum()
}

/// Hits of one histogram in each bin, and those that it would have by the hazards of all.
fn of_one(acquisition: &Acquisition, cells: &Cells, one: &Histogram) -> [Vec<f64>; 2] {
    let hits: Vec<_> = cells.limits.iter().map(|&(code, _)| f64::from(one[code])).collect();
    let waiting = waiting(acquisition.shots as f64, &hits);
    let chance = |bin: usize| cells.hits[bin] / cells.waiting[bin];
    let expected = waiting.iter().enumerate().map(|(bin, waiting)| waiting * chance(bin));
    let expected = expected.collect();
    [hits, expected]
}

/// The histogram and the box that differ most from all others, if chance does not explain it.
fn odd_one(
    acquisition: &Acquisition,
    cells: &Cells,
    histograms: &[Histogram],
) -> Option<(usize, Range<usize>, &'static str)> {
    let others = 1.0 - 1.0 / histograms.len() as f64;
    let mut worst: Option<(f64, usize, Range<usize>)> = None;
    for (number, one) in histograms.iter().enumerate() {
        let [hits, expected] = of_one(acquisition, cells, one);
        for bins in cells.boxes() {
            let [found, expected] =
                [&hits, &expected].map(|of| of[bins.clone()].iter().sum::<f64>());
            let off = ((found - expected) / (expected * others + FEW).sqrt()).abs();
            if off > ODD && worst.as_ref().is_none_or(|(most, ..)| off > *most) {
                worst = Some((off, number, bins));
            }
        }
    }
    worst.map(|(_, number, bins)| (number, bins, ALONE))
}

/// Returns the relative change of the pedestal from the first histogram to the last, by a straight line, and its standard
/// error.
pub fn change(
    acquisition: &Acquisition,
    cells: &Cells,
    ambient: &Ambient,
    support: &Range<usize>,
    histograms: &[Histogram],
) -> Option<[f64; 2]> {
    if histograms.len() < 2 {
        return None;
    }
    let amplitude = |one: &Histogram| {
        let [hits, expected] = of_one(acquisition, cells, one);
        let (mut off, mut slope, mut variance) = (0.0, 0.0, 0.0);
        for bin in support.clone() {
            let own = 1.0 - ambient.rate * cells.widths_ps[bin] / cells.hazard(bin)[0].max(1e-300);
            off += hits[bin] - expected[bin];
            slope += expected[bin] * own.max(0.0);
            variance += expected[bin];
        }
        let slope = slope.max(1.0);
        [off / slope, variance / (slope * slope)]
    };
    let last = histograms.len() as f64 - 1.0;
    let (mut product, mut squares, mut variance) = (0.0, 0.0, 0.0);
    for (number, one) in histograms.iter().enumerate() {
        let from_middle = number as f64 / last - 0.5;
        let [relative, of_relative] = amplitude(one);
        product += from_middle * relative;
        squares += from_middle * from_middle;
        variance += from_middle * from_middle * of_relative;
    }
    Some([product / squares, variance.sqrt() / squares])
}
