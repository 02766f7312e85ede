//! Stretches of time and the cells in which their avalanches are counted.
//!
//! With steady clocks a stretch has one cell. With jitter the code of an avalanche at T is that of
//! T + J: the laser edge and the edge that samples are early or late by themselves, and J is the
//! difference of the two, a normal time. Stretches are then short, and every one is spread over the
//! cells around it; within a stretch avalanches are taken to be even.

use std::f64::consts::PI;
use std::sync::Arc;

use tofsim::kernel::pulse::normal_cdf;

use crate::estimation::acquisition::{Acquisition, spans_ps};

/// Longest stretch where avalanches spread over cells [ps].
const STEP_PS: f64 = 10.0;
/// The same beside the pulse, of which pile-up leaves a narrower one [sigma].
const STEP: f64 = 0.125;
/// Range of jitter on either side [standard deviations].
const REACH: f64 = 6.0;

/// A stretch of time.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Its end [ps].
    pub until_ps: f64,
    /// Cells of its avalanches, and the part in each [code or one past the last, 1].
    pub cells: Vec<(usize, f64)>,
}

/// All that a shot is divided in.
#[derive(Clone, Debug)]
pub struct Stretches {
    /// In order of time, from 0 on.
    pub stretches: Arc<[Stretch]>,
    /// Codes that have a cell of their own.
    pub known: Vec<bool>,
    /// Length of each, where all have the same [ps].
    pub step_ps: f64,
    /// End of the last bin [ps].
    pub end_ps: f64,
}

impl Stretches {
    /// Of shots that are timed so.
    pub fn new(acquisition: &Acquisition) -> Self {
        let spans: Vec<_> = spans_ps(acquisition.bins).collect();
        let end_ps = spans.last().map_or(0.0, |&(.., until)| until);
        let limit_ps = acquisition.free_running.map_or(f64::INFINITY, |free| free.first_edge_ps());
        let none = acquisition.bins.count();
        let mut known = vec![true; none];
        for &(code, _, until_ps) in &spans {
            known[code as usize] &= until_ps <= limit_ps;
        }
        if acquisition.jitter_ps == 0.0 && acquisition.free_running.is_none() {
            return Stretches {
                stretches: sharp(&spans, none).into(),
                known,
                step_ps: 0.0,
                end_ps,
            };
        }
        let step_ps = STEP_PS.min(STEP * acquisition.pulse.sigma_ps());
        let reach_ps = REACH * acquisition.jitter_ps;
        let count = ((end_ps + reach_ps) / step_ps).ceil() as usize;
        let cell = |&(code, from_ps, until_ps): &(u16, f64, f64)| {
            (if known[code as usize] { code.into() } else { none }, from_ps, until_ps)
        };
        let spans: Vec<_> = spans.iter().map(cell).collect();
        let stretch = |k: usize| {
            let [from_ps, until_ps] = [k, k + 1].map(|k| k as f64 * step_ps);
            let around = spans.iter().filter(|(_, begin_ps, end_ps)| {
                *end_ps > from_ps - reach_ps && *begin_ps < until_ps + reach_ps
            });
            let cells = spread(around, [from_ps, until_ps], acquisition.jitter_ps, none);
            Stretch { until_ps, cells }
        };
        Stretches { stretches: (0..count).map(stretch).collect(), known, step_ps, end_ps }
    }
}

/// A stretch for each span, and for each gap between them, whose cell is `none`.
fn sharp(spans: &[(u16, f64, f64)], none: usize) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut end_ps = 0.0;
    for &(code, from_ps, until_ps) in spans {
        if from_ps > end_ps {
            stretches.push(Stretch { until_ps: from_ps, cells: vec![(none, 1.0)] });
        }
        stretches.push(Stretch { until_ps, cells: vec![(code.into(), 1.0)] });
        end_ps = until_ps;
    }
    stretches
}

/// The cells that avalanches between two times are counted in; `none` is that of no code.
fn spread<'a>(
    spans: impl Iterator<Item = &'a (usize, f64, f64)>,
    [from_ps, until_ps]: [f64; 2],
    jitter_ps: f64,
    none: usize,
) -> Vec<(usize, f64)> {
    // The part of them that is seen before a time.
    let before = |t_ps: f64| {
        let [first, last] = [from_ps, until_ps].map(|edge_ps| ramp(t_ps - edge_ps, jitter_ps));
        (first - last) / (until_ps - from_ps)
    };
    let mut left = 1.0;
    let part = |&(cell, begin_ps, end_ps): &(usize, f64, f64)| {
        let part = before(end_ps) - before(begin_ps);
        left -= part;
        (cell, part)
    };
    let mut cells: Vec<_> = spans.map(part).filter(|&(_, part)| part > 0.0).collect();
    cells.push((none, left.max(0.0)));
    cells
}

/// The mean of max(x - J, 0) for a normal J.
fn ramp(x: f64, deviation: f64) -> f64 {
    if deviation == 0.0 {
        return x.max(0.0);
    }
    let z = x / deviation;
    deviation * (z * normal_cdf(z) + libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt())
}
