//! A delay from the laser edge that goes through the window, and what the converter makes of it.

use tofsim::firmware::tdc;
use tofsim::kernel::Time;

/// Delays to a bin of the histogram.
const STEPS_OF_BIN: u64 = 25;
/// Bins of the histogram to a stretch of which a precision is said.
const BINS_OF_STRETCH: usize = 4;

/// A hit as an edge samples it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The edge that samples it, from the laser edge [fs].
    pub edge_fs: u64,
    /// Coarse count.
    pub coarse: u64,
    /// Taps that it has reached.
    pub rank: usize,
    /// Decoder's number for the taps.
    pub n: usize,
}

/// A hit so long after the laser edge, if it comes within the window.
pub fn hit(p: &tdc::Params, delay_fs: u64) -> Option<Hit> {
    let period = p.decoder.scale.period().fs();
    // The first edge at or after the arrival at tap 0, and not the laser's.
    let edge = (delay_fs + p.delays.tap_0().fs()).div_ceil(period).max(1);
    let coarse = edge - 1;
    let edge_fs = edge * period;
    let rank = p.delays.rank(Time::from_fs(edge_fs - delay_fs));
    let n = p.decoder.encoder.of_rank(rank);
    (coarse < p.coarse_counter.window()).then_some(Hit { edge_fs, coarse, rank, n })
}

/// The time that the converter has for a hit, before it becomes a code [ps].
pub fn time_ps(p: &tdc::Params, hit: &Hit) -> f64 {
    let scale = &p.decoder.scale;
    let age = p.decoder.cal[hit.n].get() as i64;
    scale.ps((scale.cycle() * (hit.coarse + 1)) as i64 - age)
}

/// One delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// From the laser edge [ps].
    pub delay_ps: f64,
    /// The hit as the edge samples it.
    pub hit: Hit,
    /// Time by the converter's ROM [ps].
    pub time_ps: f64,
    /// Time by the ROM of one that nobody has calibrated [ps].
    pub raw_time_ps: f64,
    /// Code, if the time is in range [bins].
    pub code: Option<u64>,
}

/// Errors of some neighbouring delays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Middle of them [ps].
    pub delay_ps: f64,
    /// Root of the mean square error [ps].
    pub rms_ps: f64,
    /// The same without a calibration [ps].
    pub raw_rms_ps: f64,
}

/// The whole window.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// From one delay to the next [ps].
    pub step_ps: f64,
    /// In order of delay.
    pub points: Vec<Point>,
    /// Root of the mean square error over stretches of the window.
    pub stretches: Vec<Stretch>,
    /// Standard deviation of the middle of the code's bin from the delay, where there is a code [ps].
    pub code_precision_ps: f64,
}

impl Transfer {
    /// Of a converter; `raw` is the same that nobody has calibrated.
    pub fn new(p: &tdc::Params, raw: &tdc::Params) -> Self {
        let scale = &p.decoder.scale;
        let (bin, first) = (scale.bin().fs(), scale.first().fs());
        let steps = STEPS_OF_BIN * scale.bins() as u64;
        let point = |step: u64| {
            // In the middle of its step, so that no delay is at an edge of an ideal bin.
            let delay_fs = first + bin * (2 * step + 1) / (2 * STEPS_OF_BIN);
            let hit = hit(p, delay_fs)?;
            Some(Point {
                delay_ps: delay_fs as f64 * 1e-3,
                hit,
                time_ps: time_ps(p, &hit),
                raw_time_ps: time_ps(raw, &hit),
                code: p.decoder.code(hit.coarse, hit.n).map(|code| code.get()),
            })
        };
        let points: Vec<_> = (0..steps).filter_map(point).collect();
        let rms = |part: &[Point], time: fn(&Point) -> f64| {
            let squares: f64 = part.iter().map(|at| (time(at) - at.delay_ps).powi(2)).sum();
            (squares / part.len() as f64).sqrt()
        };
        let stretches =
            points.chunks(BINS_OF_STRETCH * STEPS_OF_BIN as usize).map(|part| Stretch {
                delay_ps: part.iter().map(|at| at.delay_ps).sum::<f64>() / part.len() as f64,
                rms_ps: rms(part, |at| at.time_ps),
                raw_rms_ps: rms(part, |at| at.raw_time_ps),
            });
        let middle_ps = |code: u64| (first as f64 + (code as f64 + 0.5) * bin as f64) * 1e-3;
        let of_codes: Vec<_> =
            points.iter().filter_map(|at| Some(middle_ps(at.code?) - at.delay_ps)).collect();
        Transfer {
            step_ps: bin as f64 * 1e-3 / STEPS_OF_BIN as f64,
            stretches: stretches.collect(),
            code_precision_ps: deviation(&of_codes),
            points,
        }
    }
}

/// Standard deviation.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}
