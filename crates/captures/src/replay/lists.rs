//! Lists of photons and codes, recovered from the shots in a capture.

use std::fmt::Write;
use std::ops::RangeInclusive;

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;

use super::kind::ReplayKind;
use super::observed::{Observed, Pace, Shot};

/// Returns the latency of codes in the firmware of the scenario. A hit is sampled at least one edge after that of the
/// laser; codes from a ROM appear within the shot.
pub(super) fn pace(setup: &Setup, kind: ReplayKind) -> Pace<'_> {
    let from_rom = kind == ReplayKind::Codes;
    let to_code = if from_rom { 0 } else { setup.params.tdc.decoder.latency() + 1 };
    let frame = &setup.params.frame_ctrl;
    let pause = setup.params.histogram.bins as u64 + frame.drain_cycles;
    let periods = &setup.params.vcsel_driver.periods;
    Pace { to_code, period: setup.laser_period(), periods, pause }
}

/// Recovers photons that produce the codes or, without codes, arrive when the detector's output rose; and their
/// number.
///
/// # Errors
/// If the scenario's TDC cannot produce a code.
pub(super) fn photons(
    observed: &Observed,
    setup: &Setup,
    notes: &mut Vec<String>,
) -> Result<(String, u64)> {
    let (mut list, mut count) = ("shot,arrival_ps\n".to_owned(), 0);
    let (mut by_code, mut quantised, mut elsewhere) = (0u64, 0u64, 0u64);
    for shot in &observed.shots {
        let mut arrivals = Vec::new();
        if let Some((code, at)) = shot.code {
            let edge = edge(observed, shot, at, setup);
            let arrival = arrival(setup, code, edge);
            let Some(arrival) = arrival.or_else(|| {
                elsewhere += 1;
                edges(setup).find_map(|edge| self::arrival(setup, code, Some(edge)))
            }) else {
                let expected = format!(
                    "shot {}: the chain `{}` never gives this code; set tdc.profile",
                    shot.number, setup.scenario.tdc.profile
                );
                return Err(Input::new("tdc_code", expected).value(code).into());
            };
            arrivals.push(arrival);
            by_code += 1;
        }
        let stops = shot.stops.iter().skip(arrivals.len().min(shot.stops.len()));
        for &stop in stops {
            arrivals.push(quantised_arrival(observed, shot, stop, setup));
            quantised += 1;
        }
        for ps in arrivals {
            let _ = writeln!(list, "{},{ps}", shot.number);
            count += 1;
        }
    }
    if by_code > 0 {
        notes.push(format!(
            "{by_code} photons are placed by their codes, within the bin; taps and ones counts may \
             differ from the board's"
        ));
    }
    if quantised > 0 {
        let half = observed.timebase.step().fs() as f64 / 2e6;
        notes.push(format!(
            "{quantised} photons are placed by tdc_stop alone, to {half} ns; their hits and codes \
             may differ from the board's"
        ));
    }
    if elsewhere > 0 {
        notes.push(format!(
            "{elsewhere} codes come in another cycle than the scenario's TDC has them"
        ));
    }
    Ok((list, count))
}

/// Returns the number of the edge that sampled a hit, counted from the start of its shot; `None` if samples are not
/// consecutive.
fn edge(observed: &Observed, shot: &Shot, valid: i64, setup: &Setup) -> Option<u64> {
    let cycles = (valid - shot.start) / observed.timebase.per_cycle as i64;
    let latency = setup.params.tdc.decoder.latency() as i64;
    observed.timebase.steady.then_some((cycles - latency).max(0) as u64)
}

/// Returns the edges of a shot's window, counted from the laser's.
fn edges(setup: &Setup) -> RangeInclusive<u64> {
    1..=setup.params.tdc.coarse_counter.window()
}

/// Returns an arrival time to which the TDC assigns a code, sampled by the given edge if it is known: the middle of
/// the tap nearest to the edge [ps].
fn arrival(setup: &Setup, code: u64, edge: Option<u64>) -> Option<f64> {
    let decoder = &setup.params.tdc.decoder;
    let (cal, scale) = (&decoder.cal, &decoder.scale);
    let of_edge = |edge: u64| {
        let is_it = |n: &usize| {
            decoder.encoder.occurs(*n)
                && decoder.code(edge - 1, *n).is_some_and(|given| given.get() == code)
                && cal[*n].get() < cal[1].get() + scale.cycle()
        };
        let n = (1..cal.len()).find(is_it)?;
        Some(scale.ps((scale.cycle() * edge) as i64 - cal[n].get() as i64))
    };
    match edge {
        Some(edge) => edges(setup).contains(&edge).then(|| of_edge(edge)).flatten(),
        None => edges(setup).find_map(of_edge),
    }
}

/// Returns the middle of the sampling interval in which the detector's output rose. For a shot without code it is
/// beyond the last code, if the interval extends that far [ps].
fn quantised_arrival(observed: &Observed, shot: &Shot, stop: i64, setup: &Setup) -> f64 {
    let scale = &setup.params.tdc.decoder.scale;
    let range_ps = scale.ps(scale.range() as i64);
    let step = observed.timebase.step().fs() as f64 / 1e3;
    let begin = (stop - shot.start) as f64 * step;
    let middle = begin + step / 2.0;
    if begin + step > range_ps && observed.has_codes {
        middle.max((begin.max(range_ps) + begin + step) / 2.0)
    } else {
        middle
    }
}

/// Formats one code per shot from the first shot on, and returns their number.
///
/// # Errors
/// If a shot has none.
pub(super) fn codes(observed: &Observed, notes: &mut Vec<String>) -> Result<(String, u64)> {
    let first = observed.shots[0].number;
    let last = observed.shots.iter().rposition(|shot| shot.code.is_some());
    let shots = &observed.shots[..last.map_or(0, |last| last + 1)];
    let mut list = "code\n".to_owned();
    let mut next = 0;
    for shot in shots {
        let missing = shot.number - next;
        if missing > 0 && next < first {
            notes.push(format!("{missing} shots before the capture have code 0"));
            list += &"0\n".repeat(missing as usize);
        } else if missing > 0 {
            return Err(no_code(next).into());
        }
        let Some((code, _)) = shot.code else { return Err(no_code(shot.number).into()) };
        let _ = writeln!(list, "{code}");
        next = shot.number + 1;
    }
    if next == 0 {
        return Err(Input::new("tdc_code", "expected a code; tdc_valid never rises").into());
    }
    // The ROM is read again from its start, which would show in its address.
    list += "0\n";
    notes.push("the code after the last of the capture is 0".to_owned());
    Ok((list, next))
}

fn no_code(shot: u64) -> Input {
    let expected = format!("shot {shot} has no code; a list of codes has one for each shot");
    Input::new("tdc_code", expected)
}
