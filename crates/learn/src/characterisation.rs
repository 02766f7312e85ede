//! Characterization of a TDC: code density, linearity, bubbles, precision, and behaviour at the clock's edges.

pub mod bubbles;
pub mod decoders;
pub mod density;
pub mod edges;
pub mod rom;
pub mod timing;
pub mod transfer;

use serde::Serialize;

use tofsim::firmware::tdc;
use tofsim::firmware::tdc_decoder::{self, Decoder};
use tofsim::sim::disturbance::Disturbance;

use bubbles::Bubbles;
use density::CodeDensity;
use edges::{Edge, Phases};
use timing::TimeError;
use transfer::Transfer;

/// Stops of the thesis's Table 6.3 [ns].
const STOPS_NS: [u64; 3] = [2, 4, 8];

/// A stop so long after the start, and what the chain shows of it (Table 6.3).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stop {
    /// From the laser edge to the stop [ns].
    pub t2_ns: u64,
    /// Decoder's number for the taps.
    pub n: usize,
    /// From the laser edge to the edge that samples it [ns].
    pub t1_ns: f64,
}

/// All of it, of one converter.
#[derive(Clone, Debug)]
pub struct Characterisation {
    /// Length of the chain [taps].
    pub taps: usize,
    /// The code-density test.
    pub density: CodeDensity,
    /// The time with the ROM of a converter that nobody has calibrated.
    pub raw: TimeError,
    /// The time with the converter's own ROM.
    pub calibrated: TimeError,
    /// Taps in their physical order.
    pub bubbles: Bubbles,
    /// A delay that goes through the window.
    pub transfer: Transfer,
    /// Each edge of the clock at which the coarse count changes.
    pub edges: Vec<Edge>,
    /// Times at random.
    pub phases: Phases,
    /// Table 6.3.
    pub stops: Vec<Stop>,
}

impl Characterisation {
    /// Of a converter, with so many hits of the code-density test, and as many times at random, these with what makes
    /// the chain another at each edge: all else is of one that stands still.
    pub fn new(
        (p, disturbance): (&tdc::Params, Option<&Disturbance>),
        hits: u64,
        seed: u64,
    ) -> Self {
        let uncalibrated = tdc_decoder::Params::uniform_calibration(&p.delays, &p.decoder.scale);
        let raw = p.clone().with_calibration(uncalibrated);
        let density = CodeDensity::new(p, hits, seed);
        let reached = CodeDensity::new(&p.clone().with_decoder(Decoder::Ones), 0, seed);
        let stop = |t2_ns: u64| {
            let hit = transfer::hit(p, t2_ns * 1_000_000)?;
            let t1_ns = hit.edge_fs as f64 * 1e-6;
            Some(Stop { t2_ns, n: hit.n, t1_ns })
        };
        Characterisation {
            taps: p.delays.taps(),
            raw: TimeError::new(&raw, &density),
            calibrated: TimeError::new(p, &density),
            bubbles: Bubbles::new(&p.delays, &reached),
            transfer: Transfer::new(p, &raw),
            edges: edges::edges(p),
            phases: Phases::new(p, disturbance, hits, seed),
            stops: STOPS_NS.into_iter().filter_map(stop).collect(),
            density,
        }
    }

    /// Whether no hit is off by as much as half a period of the clock, which a wrong coarse count makes a whole.
    pub fn is_coarse_right(&self) -> bool {
        let half_ps = self.density.period_ps / 2.0;
        self.phases.off == 0 && self.edges.iter().all(|edge| edge.largest_jump_ps < half_ps)
    }
}
