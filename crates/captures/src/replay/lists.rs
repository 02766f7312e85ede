//! Lists of photons and codes, from the shots that a capture shows.

use std::fmt::Write;
use std::ops::RangeInclusive;

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;

use super::kind::ReplayKind;
use super::observed::{Observed, Pace, Shot};

/// When codes come after their shots in the firmware of the scenario: a hit is sampled an edge after the
/// laser's at the earliest. Codes from a ROM come within the shot.
pub(super) fn pace(setup: &Setup, kind: ReplayKind) -> Pace<'_> {
    let from_rom = kind == ReplayKind::Codes;
    let to_code = if from_rom { 0 } else { setup.params.tdc.decoder.latency() + 1 };
    let frame = &setup.params.frame_ctrl;
    let pause = setup.params.histogram.bins as u64 + frame.drain_cycles;
    let periods = &setup.params.vcsel_driver.periods;
    Pace { to_code, period: setup.laser_period(), periods, pause }
}

/// Photons that give the codes, or else come when the detector's output rose; and how many.
///
/// # Errors
/// When the TDC of the scenario cannot give a code.
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

/// Number of the edge that sampled a hit, counted from the shot's; `None` if time is not steady.
fn edge(observed: &Observed, shot: &Shot, valid: i64, setup: &Setup) -> Option<u64> {
    let cycles = (valid - shot.start) / observed.timebase.per_cycle as i64;
    let latency = setup.params.tdc.decoder.latency() as i64;
    observed.timebase.steady.then_some((cycles - latency).max(0) as u64)
}

/// Edges of a shot's window after the laser's.
fn edges(setup: &Setup) -> RangeInclusive<u64> {
    1..=setup.params.tdc.coarse_counter.window()
}

/// An arrival that the TDC gives that code, sampled by the edge of that number if it is known: the
/// middle of the tap next to the edge [ps].
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

/// The middle of the step in which the detector's output rose; past the last code, where the shot has
/// none, if the step reaches so far [ps].
fn quantised_arrival(observed: &Observed, shot: &Shot, stop: i64, setup: &Setup) -> f64 {
    let scale = &setup.params.tdc.decoder.scale;
    let range_ps = scale.ps(scale.range() as i64);
    let step = observed.timebase.step().fs() as f64 / 1e3;
    let begin = (stop - shot.start) as f64 * step;
    let middle = begin + step / 2.0;
    match begin + step > range_ps && observed.has_codes {
        true => middle.max((begin.max(range_ps) + begin + step) / 2.0),
        false => middle,
    }
}

/// A code for each shot from the first on, and how many.
///
/// # Errors
/// When a shot has none.
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
