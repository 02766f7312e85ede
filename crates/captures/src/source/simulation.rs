//! tofsim itself as a source: a scenario, simulated while it is read.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Params, TofTop};
use tofsim::hierarchy::{self, IDS, Part};
use tofsim::kernel::signals::{SignalFormat as Shape, Sink};
use tofsim::kernel::{Thermometer, Time};
use tofsim::sim::device::SignalProbe;
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Device, Run, WindowedProbe};
use tofsim::waves::TapDigits;

use super::names::Name;
use super::stream::{Cursor, Feed};
use super::{Axis, Format, Kind, Signal, Source, Tick};

/// What is simulated.
#[derive(Debug)]
pub(super) struct Origin {
    setup: Setup,
    frames: u64,
}

/// A simulation of so many frames.
pub(super) fn source(setup: Setup, frames: u64) -> Source {
    let mut entries = hierarchy::entries(&setup.params);
    if entries.iter().any(|entry| entry.scope == "tof_top.histogram_builder") {
        entries.extend(hierarchy::ram_entries());
    }
    let signals = entries.iter().map(|entry| Signal {
        name: Name::new(entry.path()),
        width: entry.signal.width,
        lsb: 0,
        kind: Kind::Bits,
        radix: None,
        shape: Some(entry.signal.format),
        id: entry.id,
    });
    Source {
        name: format!("scenario {}", setup.name),
        format: Format::Simulation,
        axis: Axis::Time(Tick::FEMTOSECOND),
        signals: signals.collect(),
        samples: None,
        end: None,
        radix_told: true,
        origin: super::Origin::Simulation(Arc::new(Origin { setup, frames })),
    }
}

/// Begins to simulate.
pub(super) fn read(origin: &Arc<Origin>, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
    let origin = Arc::clone(origin);
    let mut places = vec![Vec::new(); IDS];
    for (signal, &id) in ids.iter().enumerate() {
        places[id].push(signal);
    }
    Ok(Cursor::spawn(widths, move |feed| {
        let taps = TapDigits::new(origin.setup.params.tdc.delays.order());
        let values = Values { feed: &mut *feed, places, taps };
        let mut probe = Probe { values, part: Part::of(0..IDS), gone: false };
        let end = Run::new(&origin.setup).traced(origin.frames, &mut probe, None)?.end;
        // That nobody listens any more is no fault.
        let _ = feed.at(end.fs());
        Ok(())
    }))
}

/// Feeds what changes.
struct Probe<'a> {
    values: Values<'a>,
    part: Part,
    gone: bool,
}

/// Where the values go.
struct Values<'a> {
    feed: &'a mut Feed,
    /// Signals of the cursor by id.
    places: Vec<Vec<usize>>,
    taps: TapDigits,
}

impl Sink for Values<'_> {
    fn word(&mut self, id: usize, value: u64) {
        for &signal in &self.places[id] {
            self.feed.change(signal, &[value], &[0]);
        }
    }

    fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
        if self.places[id].is_empty() {
            return;
        }
        let words = self.taps.words(value);
        let unknown = vec![0; words.len()];
        for &signal in &self.places[id] {
            self.feed.change(signal, words, &unknown);
        }
    }
}

impl SignalProbe for Probe<'_> {
    const ON: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        if self.gone || self.values.feed.at(now.fs()).is_err() {
            self.gone = true;
            return;
        }
        self.part.follow(top, &mut self.values);
    }
}

impl WindowedProbe for Probe<'_> {
    fn begins_at_power_up(&mut self, device: &mut Device) -> bool {
        device.resume_clocks(Time::ZERO);
        self.sample(Time::ZERO, &device.top);
        true
    }

    fn is_wanted(&mut self, _: &mut Device, _: &Frames, _: &Params) -> Result<bool> {
        Ok(true)
    }

    fn is_done(&self) -> bool {
        self.gone
    }
}

/// The shapes of the firmware's signals, for other sources of the same names.
pub(crate) fn shapes() -> Vec<(Name, Shape)> {
    let entries = hierarchy::every_entry().into_iter().chain(hierarchy::ram_entries());
    entries.map(|entry| (Name::new(entry.path()), entry.signal.format)).collect()
}
