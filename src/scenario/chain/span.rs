//! How long a chain is beside the period of its clock.

use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

/// Periods of `clk_sys` in which the last tap must be reached: the fall that `spad_rst` makes must have left
/// the chain when the first edge after the laser edge samples the next rise, and the decoder's ages reach
/// so far.
const LONGEST: u64 = 2;

/// Of a chain whose last tap is not reached within two periods of the clock: what would do.
pub fn too_long(delays: &Delays, cycle: Time) -> Option<String> {
    let (longest, most) = (delays.longest(), Time::from_fs(LONGEST * cycle.fs()));
    if longest <= most {
        return None;
    }
    let (longest_ps, most_ns) = (longest.ps(), in_ps(most) / 1e3);
    let mhz = (LONGEST as f64 / longest.seconds() * 1e-3).floor() / 1e3;
    Some(format!(
        "the last tap is reached after {longest_ps} ps, expected {most_ns} ns at most, two periods of \
         clk_sys: one of {mhz} MHz or less would do"
    ))
}

/// Of a chain that takes less than a period of the clock from tap 0 to the end of the last tap: what would do.
///
/// A hit is seen at the first edge after it reaches tap 0, at an age of up to a period more than tap 0's.
/// What is older then than the chain is long has run through all taps, and the edge does not tell by how
/// much.
pub fn too_short(delays: &Delays, cycle: Time) -> Option<String> {
    let (taps, span) = (delays.taps(), delays.span());
    if span >= cycle {
        return None;
    }
    let (span_ps, cycle_ns, missing_ps) = (in_ps(span), in_ps(cycle) / 1e3, in_ps(cycle - span));
    let factor = (in_ps(cycle) / span_ps * 1e3).ceil() / 1e3;
    let mhz = (1.0 / span.seconds() * 1e-3).ceil() / 1e3;
    Some(format!(
        "the {taps} taps take {span_ps} ps, expected {cycle_ns} ns or more, a period of clk_sys: hits of the \
         other {missing_ps} ps would all have the same time; a delay {factor} times as long would do, or a \
         clk_sys of {mhz} MHz or more"
    ))
}

fn in_ps(time: Time) -> f64 {
    time.fs() as f64 / 1e3
}
