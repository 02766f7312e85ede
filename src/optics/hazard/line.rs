//! The broken line that stands for a pulse.

use std::sync::{Arc, LazyLock};

use crate::kernel::pulse::{Pulse, normal_cdf};

/// Pieces of the broken line [1].
pub const PIECES: usize = 1024;
/// Pieces of a Gaussian's to a sigma [1].
const PER_SIGMA: usize = 64;

/// The broken line of Phi: its nodes, every 1/64 sigma.
static NORMAL: LazyLock<Arc<[f64]>> = LazyLock::new(|| {
    nodes(|node| normal_cdf((node as f64 - (PIECES / 2) as f64) / PER_SIGMA as f64))
});

/// The nodes of a broken line whose first is 0 and whose last 1.
fn nodes(part: impl Fn(usize) -> f64) -> Arc<[f64]> {
    let inner = (1..PIECES).map(part);
    [0.0].into_iter().chain(inner).chain([1.0]).collect()
}

/// The broken line of a pulse.
pub struct Line {
    /// First node, from the mean [fs].
    pub from: f64,
    /// From one to the next [fs].
    pub step: f64,
    /// The part of the pulse that has come, at the nodes [1].
    pub parts: Arc<[f64]>,
}

impl Line {
    /// Of a Gaussian, every 1/64 sigma; of another, over its length.
    pub fn of(pulse: &Pulse) -> Self {
        let [from_ps, until_ps] = pulse.reach_ps();
        let (from, step) = (from_ps * 1e3, (until_ps - from_ps) * 1e3 / PIECES as f64);
        let parts = match pulse {
            Pulse::Gaussian { .. } => NORMAL.clone(),
            _ => nodes(|node| pulse.part((from + node as f64 * step) * 1e-3)),
        };
        Line { from, step, parts }
    }
}
