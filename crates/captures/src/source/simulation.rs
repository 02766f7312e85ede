//! A scenario as a source, simulated while it is read.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Params, TofTop};
use tofsim::hierarchy::{self, IDS, Part};
use tofsim::kernel::signals::Sink;
use tofsim::kernel::{Thermometer, Time};
use tofsim::sim::device::SignalProbe;
use tofsim::sim::frames::Frames;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Device, Run, WindowedProbe};
use tofsim::waves::TapDigits;

use super::names::Name;
use super::signals::{self, Axis, Signal, SignalKind, Source, SourceFormat, Words};
use super::stream::{Cursor, Feed};
use super::tick::Tick;

/// Time limit of a simulation without a number of frames.
pub const LONGEST_SIMULATION: Time = Time::from_ns(100_000_000);

/// Setup and number of frames of a simulation.
#[derive(Clone, Debug)]
struct SimulationOrigin {
    setup: Arc<Setup>,
    frames: Option<u64>,
}

/// Creates a source that simulates `frames` frames or, without a number, as many as are read.
pub(super) fn source(setup: Setup, frames: Option<u64>) -> Source {
    let mut entries = hierarchy::entries(&setup.params);
    if entries.iter().any(|entry| entry.scope == "tof_top.histogram_builder") {
        entries.extend(hierarchy::ram_entries(&setup.params.histogram));
    }
    let signals = entries.iter().map(|entry| Signal {
        name: Name::new(entry.path()),
        width: entry.signal.width,
        lsb: 0,
        kind: SignalKind::Bits,
        words: Words::default(),
        radix: None,
        shape: Some(entry.signal.format),
        id: entry.id,
    });
    let (name, axis) = (format!("scenario {}", setup.name), Axis::Time(Tick::FEMTOSECOND));
    let origin = SimulationOrigin { setup: Arc::new(setup), frames };
    Source::new(name, SourceFormat::Simulation, axis, signals.collect(), origin)
}

impl signals::Origin for SimulationOrigin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let SimulationOrigin { setup, frames } = self.clone();
        let mut places = vec![Vec::new(); IDS];
        for (signal, (&id, &width)) in ids.iter().zip(widths).enumerate() {
            places[id].push((signal, u64::MAX >> (64 - width.min(64))));
        }
        Ok(Cursor::spawn(widths, move |feed| {
            let taps = TapDigits::new(&setup.params.tdc.decoder.encoder);
            let values = Values { feed: &mut *feed, places, taps };
            let until = if frames.is_some() { Time::NEVER } else { LONGEST_SIMULATION };
            let mut probe =
                ChangeFeed { values, part: Part::of(0..IDS).of_whole_edges(), until, gone: false };
            let frames = frames.unwrap_or(u64::MAX);
            let end = Run::new(&setup).traced(frames, &mut probe, None)?.end;
            // That nobody listens any more is no fault.
            let _ = feed.at(end.fs());
            Ok(())
        }))
    }

    fn searched(&self) -> Result<Option<u64>> {
        if self.frames.is_some() {
            return Ok(None);
        }
        let first = Run::new(&self.setup).observe(1, Observers::default())?;
        Ok(Some(first.end.fs()))
    }
}

/// Probe of a run that sends changes to the cursor.
struct ChangeFeed<'a> {
    values: Values<'a>,
    part: Part,
    /// End of the simulation.
    until: Time,
    /// Whether the cursor has been dropped.
    gone: bool,
}

/// Sink for the values.
struct Values<'a> {
    feed: &'a mut Feed,
    /// Signals of the cursor by id, each with a mask of its bits.
    places: Vec<Vec<(usize, u64)>>,
    taps: TapDigits,
}

impl Sink for Values<'_> {
    fn word(&mut self, id: usize, value: u64) {
        for &(signal, mask) in &self.places[id] {
            self.feed.change(signal, &[value & mask], &[0]);
        }
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        if self.places[id].is_empty() {
            return;
        }
        let words = self.taps.bits(value, group).words;
        let unknown = vec![0; words.len()];
        for &(signal, _) in &self.places[id] {
            self.feed.change(signal, words, &unknown);
        }
    }
}

impl SignalProbe for ChangeFeed<'_> {
    const ON: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        if self.gone || now > self.until || self.values.feed.at(now.fs()).is_err() {
            self.gone = true;
            return;
        }
        self.part.follow(top, &mut self.values);
    }
}

impl WindowedProbe for ChangeFeed<'_> {
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
