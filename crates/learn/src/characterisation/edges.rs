//! Whether fine and coarse time part where the clock's edge comes: the plus or minus one period of many converters.

use rand::RngExt;
use serde::Serialize;

use tofsim::firmware::carry_chain::Transitions;
use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::sensor::streams::{Source, stream};
use tofsim::sim::disturbance::Disturbance;

use super::transfer::{Hit, hit, time_ps};

/// From one delay to the next, 0.1 ps [fs].
const STEP_FS: u64 = 100;
/// Range of delays on either side of an edge [fs].
const AROUND_FS: u64 = 100_000;

/// An edge of the clock that a hit just reaches or just misses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Edge {
    /// Coarse count of hits that just reach it.
    pub coarse: u64,
    /// Delay that just reaches it, from the laser edge [ps].
    pub delay_ps: f64,
    /// Largest step of the time from one delay to the next, 0.1 ps later [ps].
    pub largest_jump_ps: f64,
    /// Step of the time from the last delay that reaches it to the first that does not [ps].
    pub jump_ps: f64,
}

/// Each edge of the window that hits can be to either side of.
pub fn edges(p: &tdc::Params) -> Vec<Edge> {
    let period = p.decoder.scale.period().fs();
    let edge = |coarse: u64| {
        let at = ((coarse + 1) * period).checked_sub(p.delays.tap_0().fs())?;
        let time = |delay_fs: u64| hit(p, delay_fs).map(|hit| time_ps(p, &hit));
        let jump = |from: u64, to: u64| Some((time(to)? - time(from)?).abs());
        let from = at.saturating_sub(AROUND_FS);
        let steps = (from..at + AROUND_FS).step_by(STEP_FS as usize);
        let largest = steps.filter_map(|fs| jump(fs, fs + STEP_FS)).fold(0.0, f64::max);
        // Past the last one the window is closed.
        let jump_ps = jump(at, at + 1)?;
        Some(Edge {
            coarse,
            delay_ps: at as f64 * 1e-3,
            largest_jump_ps: largest.max(jump_ps),
            jump_ps,
        })
    };
    (0..p.coarse_counter.window()).filter_map(edge).collect()
}

/// Hits at random within the window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Phases {
    /// Number of delays.
    pub count: u64,
    /// Of them, those whose time is off by half a period of the clock or more.
    #[serde(rename = "off_by_a_period")]
    pub off: u64,
    /// Largest error [ps].
    pub largest_error_ps: f64,
    /// Root of the mean square error [ps].
    pub rms_error_ps: f64,
}

impl Phases {
    /// So many of them, of a chain that is another at each edge if there is a disturbance.
    pub fn new(p: &tdc::Params, disturbance: Option<&Disturbance>, count: u64, seed: u64) -> Self {
        let period = p.decoder.scale.period().fs();
        let window = p.coarse_counter.window() * period;
        let end = window.saturating_sub(p.delays.tap_0().fs()).max(1);
        let (mut random, mut disturbance) =
            (stream(seed, Source::CodeDensity, 1), disturbance.cloned());
        let mut phases = Phases { count: 0, off: 0, largest_error_ps: 0.0, rms_error_ps: 0.0 };
        let mut squares = 0.0;
        for nth in 0..count {
            let delay_fs = random.random_range(0..end);
            let found = match &mut disturbance {
                Some(disturbance) => sampled(p, disturbance, 2 * nth * window, delay_fs),
                None => hit(p, delay_fs),
            };
            let Some(hit) = found else { continue };
            let error_ps = (time_ps(p, &hit) - delay_fs as f64 * 1e-3).abs();
            phases.count += 1;
            phases.off += u64::from(error_ps >= period as f64 * 0.5e-3);
            phases.largest_error_ps = phases.largest_error_ps.max(error_ps);
            squares += error_ps * error_ps;
        }
        phases.rms_error_ps = (squares / phases.count.max(1) as f64).sqrt();
        phases
    }
}

/// Returns the registered taps of a hit at a time from a laser edge, edge by edge; empty if tap 0 is not reached
/// before the window ends.
fn sampled(
    p: &tdc::Params,
    disturbance: &mut Disturbance,
    laser_fs: u64,
    delay_fs: u64,
) -> Option<Hit> {
    let period = p.decoder.scale.period().fs();
    let mut transitions = Transitions::default();
    transitions.push(Time::from_fs(laser_fs + delay_fs));
    let first = delay_fs.div_ceil(period).max(1);
    (first..=p.coarse_counter.window()).find_map(|edge| {
        let edge_fs = edge * period;
        let taps =
            disturbance.sample(true, &transitions, Time::from_fs(laser_fs + edge_fs), &p.delays);
        let hit = || {
            let rank = p.delays.rank(Time::from_fs(edge_fs - delay_fs));
            Hit { edge_fs, coarse: edge - 1, rank, n: p.decoder.number(&taps) }
        };
        taps.tap(p.delays.tap_0_position()).then(hit)
    })
}
