//! Length limits of a chain, relative to the clock period.

use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

/// Number of `clk_sys` periods within which the last tap must be reached: the falling edge due to `spad_rst` must
/// have left the chain when the first edge after the laser edge samples the next rising edge, and the decoder's ages
/// extend no further.
const LONGEST: u64 = 2;

/// Checks that the last tap is reached within two clock periods; if not, returns a message that suggests a clock
/// frequency.
pub fn too_long(delays: &Delays, cycle: Time) -> Option<String> {
    let (longest, most) = (delays.longest(), Time::from_fs(LONGEST * cycle.fs()));
    if longest <= most {
        return None;
    }
    let (longest_ps, most_ns) = (longest.ps(), in_ps(most) / 1e3);
    let mhz = (LONGEST as f64 / longest.seconds() * 1e-3).floor() / 1e3;
    Some(format!(
        "the last tap is reached after {longest_ps} ps, expected {most_ns} ns at most, two periods of \
         clk_sys; use one of {mhz} MHz or less (pll)"
    ))
}

/// Checks that the chain covers a clock period, from tap 0 to the end of the last tap; if not, returns a message that
/// suggests a delay factor or a clock frequency.
///
/// A hit is sampled at the first edge after it reaches tap 0, so its age reaches up to one period more than that of
/// tap 0. A hit older than the chain's length has passed all taps, and its age cannot be resolved.
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
         other {missing_ps} ps would all have the same time; use tap delays {factor} times as long (tdc.profile), or a \
         clk_sys of {mhz} MHz or more (pll)"
    ))
}

fn in_ps(time: Time) -> f64 {
    time.fs() as f64 / 1e3
}
