//! Shots in a capture, with the detector's and the TDC's response to each.

mod earlier;
mod probes;

use tofsim::error::{Input, Result};

use crate::compare::Probed;
use crate::source::Source;

use super::kind::ReplayKind;
use super::numbers::Numbers;
use super::pins::Pins;
use super::timebase::Timebase;
use probes::Probes;

/// A shot in a capture.
#[derive(Clone, Debug, Default)]
pub(super) struct Shot {
    /// Number since power-up, if the capture begins in the first frame.
    pub(super) number: u64,
    /// Window that contains it.
    window: usize,
    /// First sample after its start; negative before the capture.
    pub(super) start: i64,
    /// Code, and the first sample with it.
    pub(super) code: Option<Code>,
    /// First samples with a high output of the detector.
    pub(super) stops: Vec<i64>,
}

/// A code, and the first sample with it.
type Code = (u64, i64);

/// Latency of codes relative to their shots [cycles of clk_sys].
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace<'a> {
    /// Smallest latency from a shot to its code.
    pub(super) to_code: u64,
    /// Shot period.
    pub(super) period: u64,
    /// Possible shot periods.
    pub(super) periods: &'a [u64],
    /// Length of Clear and Drain, between frames.
    pub(super) pause: u64,
}

/// Contents of a capture.
#[derive(Clone, Debug)]
pub(super) struct Observed {
    pub(super) timebase: Timebase,
    pub(super) shots: Vec<Shot>,
    /// Whether the capture contains codes.
    pub(super) has_codes: bool,
    pub(super) per_frame: Option<u64>,
    /// Shot period, if it is constant [cycles of clk_sys].
    pub(super) period: Option<u64>,
    /// Start of each window.
    pub(super) windows: Vec<Begin>,
    pub(super) pins: Pins,
    /// Number of samples.
    pub(super) samples: u64,
    pub(super) notes: Vec<String>,
}

/// Start of a window, before its first shot.
#[derive(Clone, Debug, Default)]
pub(super) struct Begin {
    /// Index of its first shot.
    first: usize,
    /// First samples with a high output of the detector before that shot.
    stops: Vec<i64>,
    /// Codes before those of its shots.
    codes: Vec<Code>,
    /// Code that the TDC still holds from an earlier shot.
    held: Option<u64>,
}

/// Reads the shots of a capture; `None` if it shows neither the detector's nor the TDC's response to them.
///
/// # Errors
/// If the capture cannot be read, or does not show where shots begin.
pub(super) fn observe(
    capture: &Source,
    probed: &mut Probed,
    kind: ReplayKind,
    timebase: Timebase,
    shots_per_frame: u64,
    pace: Pace<'_>,
) -> Result<Option<Observed>> {
    let Some(mut probes) = Probes::new(probed, kind) else { return Ok(None) };
    if probes.start.probe.is_none() {
        let expected = "does not show where the shots begin; probe vcsel_driver.start";
        return Err(Input::new(&capture.name, expected).into());
    }
    let mut numbers = Numbers::new(shots_per_frame);
    let mut observed = Observed::new(timebase, probes.code.is_some(), Pins::new(probed));
    let mut is_early = false;
    while let Some(sample) = probed.next()? {
        observed.samples += 1;
        let begins = sample.marks.window || observed.windows.is_empty();
        if begins {
            let first = observed.shots.len();
            observed.windows.push(Begin { first, ..Begin::default() });
            probes.begin_window();
            numbers.across = observed.windows.len() > 1;
        }
        if numbers.across && probes.counter.is_none() {
            let expected = "has several windows, and does not show how many shots lie between \
                them; probe frame_ctrl.shots";
            return Err(Input::new(&capture.name, expected).into());
        }
        observed.pins.sample(sample.index, probed);
        let counted = probes.counter.and_then(|counter| probed.value(counter));
        let (acquires, acquired) = probes.acquire.sample(probed);
        numbers.frame(counted, acquires, acquired);
        if probes.start.pulse(probed, &observed.timebase) {
            let number = numbers.start(counted);
            let (start, window) = (sample.index as i64, observed.windows.len());
            observed.shots.push(Shot { number, window, start, ..Shot::default() });
        }
        let (is_high, was_high) = probes.stop.sample(probed);
        is_early |= is_high && observed.shots.is_empty();
        let is_valid = probes.valid.pulse(probed, &observed.timebase);
        let value = probes.code.and_then(|code| probed.value(code));
        let Some(begin) = observed.windows.last_mut() else { continue };
        let (shots, at) = (&mut observed.shots[begin.first..], sample.index as i64);
        if is_high && !was_high {
            shots.last_mut().map_or(&mut begin.stops, |shot| &mut shot.stops).push(at);
        }
        match value {
            Some(value) if is_valid => match pace.shot_of(at, shots, &observed.timebase) {
                Some(shot) => shot.code = Some((value, at)),
                None => begin.codes.push((value, at)),
            },
            held if begins && kind == ReplayKind::Photons => begin.held = held,
            _ => {}
        }
    }
    if observed.shots.is_empty() {
        let expected = "shows no shot: vcsel_driver.start never rises in it";
        return Err(Input::new(&capture.name, expected).into());
    }
    observed.period = period(&observed, pace.periods);
    observed.per_frame = numbers.per_frame.or_else(|| first_pause(&observed, pace));
    observed.add_earlier(pace);
    observed.add_notes(probes.counter.is_some() || numbers.begun, is_early);
    Ok(Some(observed))
}

impl Pace<'_> {
    /// Returns the shot of a code first seen at a sample, if it is among the given ones. If samples are not
    /// consecutive, the usual number of shots is assumed to have begun since.
    fn shot_of<'a>(
        &self,
        at: i64,
        shots: &'a mut [Shot],
        timebase: &Timebase,
    ) -> Option<&'a mut Shot> {
        if timebase.steady {
            let to_code = (self.to_code * timebase.per_cycle) as i64;
            return shots.iter_mut().rfind(|shot| shot.start + to_code <= at);
        }
        let begun_since = (self.to_code / self.period) as usize;
        shots.iter_mut().nth_back(begun_since)
    }
}

impl Observed {
    fn new(timebase: Timebase, has_codes: bool, pins: Pins) -> Observed {
        let (shots, windows, notes) = (Vec::new(), Vec::new(), Vec::new());
        let (per_frame, period, samples) = (None, None, 0);
        Observed { timebase, shots, has_codes, per_frame, period, windows, pins, samples, notes }
    }

    /// Adds notes on information that the capture does not show.
    fn add_notes(&mut self, is_placed: bool, is_early: bool) {
        let first = self.shots[0].number;
        let notes = &mut self.notes;
        if !is_placed {
            notes.push(
                "the first shot of the capture is taken as the first of a frame; frame_ctrl.shots or \
                 acquire would say which it is"
                    .to_owned(),
            );
        }
        if first > 0 {
            notes.push(format!("the {first} shots of the frame before the capture are not known"));
        }
        if is_early {
            notes.push(
                "tdc_stop is high before the first shot, where a list of photons has none"
                    .to_owned(),
            );
        }
        if self.windows.len() > 1 {
            notes.push(
                "windows that begin with fewer shots than the one before are taken to be of the next \
                 frame; the shots between windows are not known"
                    .to_owned(),
            );
        }
        if self.per_frame.is_none() {
            notes.push("the capture does not show how many shots a frame has".to_owned());
        }
    }

    /// Returns whether all samples are consecutive.
    pub(super) fn is_continuous(&self) -> bool {
        self.timebase.steady && self.windows.len() == 1
    }
}

/// Returns the number of shots before the first pause between frames, if the capture does not show the number per
/// frame.
fn first_pause(observed: &Observed, pace: Pace) -> Option<u64> {
    let apart = |shots: &[Shot]| {
        let cycles = (shots[1].start - shots[0].start) as u64 / observed.timebase.per_cycle;
        observed.is_continuous() && cycles > pace.pause && !pace.periods.contains(&cycles)
    };
    let last = observed.shots.windows(2).find(|shots| apart(shots))?;
    Some(last[0].number + 1)
}

/// Returns the most common number of cycles between consecutive shots, if it is one of the laser's periods.
fn period(observed: &Observed, periods: &[u64]) -> Option<u64> {
    if !observed.timebase.steady {
        return None;
    }
    let apart = observed.shots.windows(2).filter_map(|shots| {
        let apart = (shots[1].start - shots[0].start) as u64 / observed.timebase.per_cycle;
        let follows = shots[1].number == shots[0].number + 1 && shots[1].window == shots[0].window;
        follows.then_some(apart)
    });
    let first = apart.min()?;
    periods.contains(&first).then_some(first)
}
