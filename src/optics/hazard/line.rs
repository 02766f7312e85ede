//! Piecewise linear approximation of a cumulative pulse.

use std::sync::{Arc, LazyLock};

use crate::kernel::pulse::{Pulse, normal_cdf};
use crate::optics::budget::Budget;

/// Number of segments of a pulse [1].
const PIECES: usize = 1024;
/// Number of segments per sigma of a Gaussian [1].
const PER_SIGMA: usize = 64;

/// Nodes of Phi, every 1/64 sigma.
static NORMAL: LazyLock<Arc<[f64]>> = LazyLock::new(|| {
    nodes(|node| normal_cdf((node as f64 - (PIECES / 2) as f64) / PER_SIGMA as f64))
});

/// Computes the nodes, scaled so that the first is 0 and the last is 1.
fn nodes(part: impl Fn(usize) -> f64) -> Arc<[f64]> {
    let inner = (1..PIECES).map(part);
    [0.0].into_iter().chain(inner).chain([1.0]).collect()
}

/// Piecewise linear cumulative light of a shot.
pub struct Line {
    /// First node, from the laser edge [fs].
    pub start: f64,
    /// Time between nodes [fs].
    pub step: f64,
    /// Cumulative fraction of the light at the nodes [1].
    pub parts: Arc<[f64]>,
    /// The same for the light of the cover window, as a fraction of all light; empty without a window [1].
    pub cover: Arc<[f64]>,
}

impl Line {
    /// Returns the cumulative light of a scene.
    pub fn of(budget: &Budget) -> Self {
        match &budget.spread {
            None => Line::of_echo(&budget.pulse, budget.mean_arrival.fs() as f64),
            Some(spread) => {
                let (amounts, from) = (budget.by_origin(), spread.from);
                let (parts, cover) = (spread.of(amounts), spread.of_cover(amounts));
                Line { start: from, step: spread.step, parts, cover }
            }
        }
    }

    /// Returns the cumulative light of one echo: every 1/64 sigma of a Gaussian, or over the length of another pulse.
    fn of_echo(pulse: &Pulse, mean: f64) -> Self {
        let [from_ps, until_ps] = pulse.reach_ps();
        let (from, step) = (from_ps * 1e3, (until_ps - from_ps) * 1e3 / PIECES as f64);
        let parts = match pulse {
            Pulse::Gaussian { .. } => NORMAL.clone(),
            _ => nodes(|node| pulse.part((from + node as f64 * step) * 1e-3)),
        };
        Line { start: mean + from, step, parts, cover: Arc::default() }
    }
}
