//! A run again from what a capture shows of its inputs: photons, codes or a histogram in the place of
//! light, and the control signals.

mod histogram;
mod kind;
mod lists;
mod numbers;
mod observed;
mod pins;
mod sums;
mod timebase;

use tofsim::error::{Input, Result};
use tofsim::hierarchy::TOP;
use tofsim::scenario::Control;
use tofsim::sim::setup::Setup;

use crate::compare::{Probed, SampleClock, SignalMap, pulse};
use crate::source::Source;

pub use kind::ReplayKind;
use observed::{Observed, observe};
use timebase::Timebase;

/// What a capture is read by.
#[derive(Clone, Debug, Default)]
pub struct ReplayOptions {
    /// What belongs together by intention.
    pub map: SignalMap,
    /// The analyser's clock, instead of the map's.
    pub clock: Option<SampleClock>,
    /// Not every edge of the clock has a sample.
    pub qualified: bool,
    /// What stands in for the light, instead of the most faithful that the capture shows.
    pub kind: Option<ReplayKind>,
}

/// What a capture shows of a run's inputs.
#[derive(Clone, Debug)]
pub struct Replay {
    /// What stands in for the light.
    pub kind: ReplayKind,
    /// The list as CSV.
    pub list: String,
    /// How many photons, codes or words it has.
    pub entries: u64,
    /// What the capture does not show, and what was taken instead.
    pub notes: Vec<String>,
    observed: Option<Observed>,
}

/// Where a capture lies in the simulation of what it shows.
#[derive(Clone, Debug, Default)]
pub struct Located {
    /// Samples by which the capture is later than the simulation, where that is one number.
    pub offset: Option<i64>,
    /// Changes of the control signals.
    pub changes: Vec<Control>,
}

impl Replay {
    /// Shots that the capture shows.
    pub fn shots(&self) -> u64 {
        self.observed.as_ref().map_or(0, |observed| observed.shots.len() as u64)
    }

    /// Shots of a frame, if the capture shows them.
    pub fn shots_per_frame(&self) -> Option<u64> {
        self.observed.as_ref()?.per_frame
    }

    /// Cycles between two shots, if the capture shows them [cycles of clk_sys].
    pub fn period(&self) -> Option<u64> {
        self.observed.as_ref()?.period
    }

    /// The control signals as the capture begins, as far as it shows them.
    pub fn begin(&self) -> Control {
        self.observed.as_ref().map(|observed| observed.pins.begin()).unwrap_or_default()
    }

    /// Finds where the capture lies in `setup`, which has the list and what the control signals are at
    /// its begin, and with that when these change.
    ///
    /// # Errors
    /// When the simulation does not come to the capture's first shot, or the capture does not say when
    /// a control signal changes.
    pub fn locate(&self, setup: &Setup) -> Result<Located> {
        let Some(observed) = &self.observed else { return Ok(Located::default()) };
        let (timebase, shot) = (&observed.timebase, &observed.shots[0]);
        let changes = &observed.pins.changes;
        if !observed.is_continuous() {
            if let Some((sample, ..)) = changes.first() {
                let expected = "a control signal changes there, but the samples do not tell when";
                return Err(Input::new("capture", expected).value(sample).into());
            }
            return Ok(Located::default());
        }
        let start = format!("{TOP}.start");
        let simulation = Source::simulation(setup.clone(), None);
        let Some((index, at)) = pulse(&simulation, &timebase.clock, &start, shot.number)? else {
            let expected = format!("the simulation never comes to shot {}", shot.number);
            return Err(Input::new(&simulation.name, expected).into());
        };
        let step_fs = i128::from(timebase.step().fs());
        let when = |&(sample, late, ref change): &(u64, u64, Control)| {
            let edges = i128::from(sample) - i128::from(shot.start);
            let late = i128::from(2 * late * timebase.per_cycle + 1);
            let fs = i128::from(at) + edges * step_fs - late * step_fs / 2;
            Control { at_us: fs.max(0) as f64 / 1e9, ..change.clone() }
        };
        let offset = Some(shot.start - index as i64);
        Ok(Located { offset, changes: changes.iter().map(when).collect() })
    }
}

/// Reads from a capture what a run of `setup` needs to be the same.
///
/// # Errors
/// When the capture cannot be read, or does not show enough; the error says what to probe.
pub fn replay(capture: &Source, setup: &Setup, options: &ReplayOptions) -> Result<Replay> {
    if !capture.is_capture() {
        let expected = "expected a capture of a logic analyser";
        return Err(Input::new(&capture.name, expected).value(capture.format.name()).into());
    }
    let kinds = options.kind.as_ref().map_or(&ReplayKind::ALL[..], std::slice::from_ref);
    let mut fault = None;
    for &kind in kinds {
        match of_kind(capture, setup, options, kind) {
            Ok(Some(replay)) => return Ok(replay),
            Ok(None) => {}
            // A map of one design names what another has not.
            Err(error) => fault = fault.or(Some(error)),
        }
    }
    let probes: Vec<_> = kinds.iter().map(|kind| kind.probes()).collect();
    let expected = format!("does not show what to replay; probe {}", probes.join("; or "));
    Err(fault.unwrap_or_else(|| Input::new(&capture.name, expected).into()))
}

/// A replay of that kind, `None` if nothing of it is probed.
fn of_kind(
    capture: &Source,
    setup: &Setup,
    options: &ReplayOptions,
    kind: ReplayKind,
) -> Result<Option<Replay>> {
    let design = kind.design(setup);
    let mut probed = Probed::new(&design, capture, &options.map)?;
    let timebase =
        Timebase::new(options.clock.as_ref(), &options.map, options.qualified, setup.cycle());
    let mut notes = Vec::new();
    if kind == ReplayKind::Histogram {
        let alone = "a preloaded histogram drives the estimator alone, frame after frame without \
            shots: only what the estimator does is the same";
        notes.push(alone.to_owned());
        let words = histogram::readout(&mut probed, setup.params.histogram.bins, &mut notes)?;
        let words = match words {
            None => from_sums(capture, setup, &mut probed, timebase, &mut notes)?,
            words => words,
        };
        let Some(words) = words else { return Ok(None) };
        let (list, entries) = (histogram::list(capture, &words)?, words.len() as u64);
        return Ok(Some(Replay { kind, list, entries, notes, observed: None }));
    }
    let timebase = timebase?;
    let shots_per_frame = setup.scenario.firmware.shots_per_frame;
    let pace = lists::pace(setup, kind);
    let observed = observe(capture, &mut probed, kind, timebase, shots_per_frame, pace)?;
    let Some(observed) = observed else {
        return Ok(None);
    };
    notes.extend(observed.notes.iter().cloned());
    let (list, entries) = match kind {
        ReplayKind::Photons => lists::photons(&observed, setup, &mut notes)?,
        _ => lists::codes(&observed, &mut notes)?,
    };
    Ok(Some(Replay { kind, list, entries, notes, observed: Some(observed) }))
}

/// The histogram from the sums of the hidden layer, by the weights of the scenario's network.
fn from_sums(
    capture: &Source,
    setup: &Setup,
    probed: &mut Probed,
    timebase: Result<Timebase>,
    notes: &mut Vec<String>,
) -> Result<Option<histogram::Words>> {
    // A clock of one's own tells nothing of the cycles, but asks for nothing where there are no sums.
    let (per_cycle, steady) = timebase.map_or((1, false), |own| (own.per_cycle, own.steady));
    let words = sums::words(capture, probed, per_cycle, &setup.params)?;
    if words.is_some() {
        if !steady {
            let expected = "expected all samples of clk_sys or clk_laser, to take the sums apart";
            return Err(Input::new("--clock", expected).into());
        }
        notes.push("the words are taken from the sums of the hidden layer".to_owned());
    }
    Ok(words)
}
