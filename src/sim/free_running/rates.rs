//! Count rate against incident rate, beside the closed forms of both dead times.
//!
//! With n the incident rate and tau the dead time these are n / (1 + n tau) for a fixed one and n exp(-n tau) for one
//! that starts again (Knoll, Radiation Detection and Measurement, chapter 4).

use crate::kernel::Time;

use super::{BATCHES, FreeRunning, Measured};

/// Points to a decade, and their number: n tau from 0.001 to 10.
const TO_A_DECADE: i32 = 2;
const POINTS: i32 = 9;
const FIRST: f64 = 1e-3;
/// Part of a batch that passes before it is counted.
const WARM_UP: f64 = 0.1;
/// Incident carriers at most to each count that is asked for.
const MOST_CARRIERS: f64 = 10.0;

/// Count rates at an incident rate.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Incident rate [1/s].
    pub incident_hz: f64,
    /// Counts with a fixed dead time and with one that starts again, without afterpulses [1/s].
    pub counted_hz: [Measured; 2],
    /// Their closed forms [1/s].
    pub closed_form_hz: [f64; 2],
    /// Counts of the scenario's diode, if it has afterpulses [1/s].
    pub own_hz: Option<Measured>,
}

/// Four decades of light, with about so many counts at each rate.
pub fn rates(diode: &FreeRunning, counts: u64) -> Vec<Point> {
    (0..POINTS).map(|k| point(diode, counts, k)).collect()
}

fn point(diode: &FreeRunning, counts: u64, k: i32) -> Point {
    let dead_s = diode.dead_time_s();
    let part = FIRST * 10f64.powf(f64::from(k) / f64::from(TO_A_DECADE));
    let incident_hz = part / dead_s;
    let closed_form_hz = [incident_hz / (1.0 + part), incident_hz * (-part).exp()];
    let measure = |diode: &FreeRunning, kind: u64, expected_hz: f64| {
        let counts = counts as f64;
        let whole_s = (counts / expected_hz).min(MOST_CARRIERS * counts / incident_hz);
        let batch_s = whole_s / BATCHES as f64;
        let [from, until] = [WARM_UP * batch_s, batch_s].map(|s| Time::from_fs((s * 1e15) as u64));
        let batch = |batch: u64| {
            let run = (kind * POINTS as u64 + k as u64) * BATCHES + batch;
            let mut counted = 0u64;
            diode.counts([incident_hz, 0.0], run, until, |at| counted += u64::from(at > from));
            counted as f64 / (until - from).seconds()
        };
        Measured::of(&(0..BATCHES).map(batch).collect::<Vec<_>>())
    };
    let plain = |kind: usize| {
        measure(&diode.without_afterpulses(kind == 1), kind as u64, closed_form_hz[kind])
    };
    let has_afterpulses = diode.effects.trap_probability > 0.0;
    let own = usize::from(diode.effects.paralysable);
    Point {
        incident_hz,
        counted_hz: [plain(0), plain(1)],
        closed_form_hz,
        own_hz: has_afterpulses.then(|| measure(diode, 2, closed_form_hz[own])),
    }
}
