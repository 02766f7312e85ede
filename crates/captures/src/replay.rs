//! Replay of a capture: a run with the inputs that the capture shows, which are photons, codes or a histogram in
//! place of light, and the control signals.

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
use crate::ila::probes::{below, column};
use crate::source::Source;

pub use kind::ReplayKind;
use observed::{Observed, observe};
use timebase::Timebase;

/// Options for reading a capture.
#[derive(Clone, Debug, Default)]
pub struct ReplayOptions {
    /// Explicit matching of names.
    pub map: SignalMap,
    /// Clock of the analyser; overrides the map's.
    pub clock: Option<SampleClock>,
    /// Whether samples were stored only under a condition, so that clock edges may lack a sample.
    pub qualified: bool,
    /// Stimulus that replaces the light; by default the most accurate one that the capture shows.
    pub kind: Option<ReplayKind>,
}

/// Inputs of a run, recovered from a capture.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Stimulus that replaces the light.
    pub kind: ReplayKind,
    /// Stimulus file, as CSV.
    pub list: String,
    /// Number of photons, codes or histogram bins in it.
    pub entries: u64,
    /// Notes on inputs that the capture does not show, with the values assumed.
    pub notes: Vec<String>,
    observed: Option<Observed>,
}

/// Position of a capture in the simulation that replays it.
#[derive(Clone, Debug, Default)]
pub struct Located {
    /// Offset of the capture relative to the simulation, if it is constant [samples].
    pub offset: Option<i64>,
    /// Changes of the control signals.
    pub changes: Vec<Control>,
}

impl Replay {
    /// Returns the number of shots in the capture.
    pub fn shots(&self) -> u64 {
        self.observed.as_ref().map_or(0, |observed| observed.shots.len() as u64)
    }

    /// Returns the number of shots per frame, if the capture shows it.
    pub fn shots_per_frame(&self) -> Option<u64> {
        self.observed.as_ref()?.per_frame
    }

    /// Returns the shot period, if the capture shows it [cycles of clk_sys].
    pub fn period(&self) -> Option<u64> {
        self.observed.as_ref()?.period
    }

    /// Returns the control signals at the start of the capture, as far as it shows them.
    pub fn begin(&self) -> Control {
        self.observed.as_ref().map(|observed| observed.pins.begin()).unwrap_or_default()
    }

    /// Locates the capture in the simulation of `setup`, which has the recovered stimulus and the initial control
    /// signals, and derives the times at which these change.
    ///
    /// # Errors
    /// If the simulation does not reach the capture's first shot, or the time of a change cannot be determined.
    pub fn locate(&self, setup: &Setup) -> Result<Located> {
        let Some(observed) = &self.observed else { return Ok(Located::default()) };
        let (timebase, shot) = (&observed.timebase, &observed.shots[0]);
        let changes = &observed.pins.changes;
        if !observed.is_continuous() {
            if let Some((sample, ..)) = changes.first() {
                let expected = "a control signal changes there, but the samples do not show when";
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

/// Recovers the inputs of a run from a capture of it.
///
/// # Errors
/// If the capture cannot be read or does not show enough; the error lists the signals to probe.
pub fn replay(capture: &Source, setup: &Setup, options: &ReplayOptions) -> Result<Replay> {
    if !capture.is_capture() {
        let expected = "expected a capture of a logic analyser";
        return Err(Input::new(&capture.name, expected).value(capture.format).into());
    }
    let names = capture.signals.iter().map(|signal| &signal.name.text);
    let mapped = options.map.signal.iter().flat_map(|rule| &rule.a);
    if let Some(name) = names.chain(mapped).find(|name| column(&below(name)).is_some()) {
        let expected =
            "expected probes of a single pixel only: a list of photons or codes is of one pixel";
        return Err(Input::new(&capture.name, expected).field(name).into());
    }
    let kinds = options.kind.as_ref().map_or(ReplayKind::ALL, std::slice::from_ref);
    let mut fault = None;
    for &kind in kinds {
        match of_kind(capture, setup, options, kind) {
            Ok(Some(replay)) => {
                let notes = [&capture.notes[..], &replay.notes].concat();
                return Ok(Replay { notes, ..replay });
            }
            Ok(None) => {}
            // A map of one design names what another has not.
            Err(error) => fault = fault.or(Some(error)),
        }
    }
    let probes: Vec<_> = kinds.iter().map(|kind| kind.probes()).collect();
    let expected = format!("does not show what to replay; probe {}", probes.join("; or "));
    Err(fault.unwrap_or_else(|| Input::new(&capture.name, expected).into()))
}

/// Recovers a stimulus of one kind; `None` if none of its signals are probed.
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

/// Recovers the histogram from the sums of the hidden layer, with the weights of the scenario's network.
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
