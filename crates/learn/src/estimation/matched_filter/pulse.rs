//! The pulse in the bins of a chain, as the matched filter tries it.

use tofsim::kernel::pulse;
use tofsim::optics::Bins;

use crate::estimation::acquisition::{Acquisition, spans_ps};

/// Range of a Gaussian on either side of its mean [sigma].
const REACH: f64 = 5.0;

/// A bin, which a chain may give in several pieces.
pub struct Pieces {
    /// Its code.
    pub code: u16,
    /// From and until [ps].
    pub spans: Vec<[f64; 2]>,
}

/// Bins by their first time.
pub fn pieces(bins: &Bins) -> Vec<Pieces> {
    let mut pieces: Vec<Pieces> = Vec::new();
    for (code, from, until) in spans_ps(bins) {
        match pieces.iter_mut().find(|bin| bin.code == code) {
            Some(bin) => bin.spans.push([from, until]),
            None => pieces.push(Pieces { code, spans: vec![[from, until]] }),
        }
    }
    pieces
}

impl Pieces {
    /// Returns its width [ps].
    pub fn width_ps(&self) -> f64 {
        self.spans.iter().map(|[from, until]| until - from).sum()
    }
}

/// The pulse at one arrival.
#[derive(Clone, Debug)]
pub struct Pulse {
    /// The first bin that sees it.
    pub first: usize,
    /// The parts of it there and in the following bins [1].
    pub parts: Vec<f64>,
}

impl Pulse {
    /// Returns a pulse of a shape in some bins.
    pub fn new(bins: &[Pieces], arrival_ps: f64, shape: &pulse::Pulse) -> Self {
        // What would come before the laser edge comes with it.
        let before = |t_ps: f64| if t_ps > 0.0 { shape.part(t_ps - arrival_ps) } else { 0.0 };
        let [from_ps, until_ps] = reach_ps(shape).map(|ps| arrival_ps + ps);
        let sees = |bin: &Pieces| bin.spans.iter().any(|[a, b]| *b > from_ps && *a < until_ps);
        let part = |bin: &Pieces| bin.spans.iter().map(|[a, b]| before(*b) - before(*a)).sum();
        let first = bins.iter().position(sees).unwrap_or(0);
        let past = bins.iter().rposition(sees).map_or(first, |last| last + 1);
        Pulse { first, parts: bins[first..past].iter().map(part).collect() }
    }
}

/// The pulse as jitter leaves it. Exact for a faint one only, because pile-up comes before jitter, and of a
/// measured one its width alone is left, where there is jitter.
pub fn seen(acquisition: &Acquisition) -> pulse::Pulse {
    use pulse::Pulse::{Gaussian, Tailed};
    let jitter_ps = acquisition.jitter_ps;
    match acquisition.pulse {
        pulse if jitter_ps == 0.0 => pulse.clone(),
        Tailed { sigma_ps, tail_ps } => {
            Tailed { sigma_ps: sigma_ps.hypot(jitter_ps), tail_ps: *tail_ps }
        }
        pulse => Gaussian { sigma_ps: pulse.sigma_ps().hypot(jitter_ps) },
    }
}

/// Returns the range in which the pulse is considered, from its mean [ps].
fn reach_ps(shape: &pulse::Pulse) -> [f64; 2] {
    match shape {
        pulse::Pulse::Gaussian { sigma_ps } => [-REACH * sigma_ps, REACH * sigma_ps],
        other => other.ends_ps(),
    }
}
