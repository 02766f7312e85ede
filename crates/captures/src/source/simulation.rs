//! A scenario as a source, simulated while it is read: a single pixel, or the firmware that scans an array.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Params, TofTop};
use tofsim::hierarchy::{self, IDS, Part};
use tofsim::kernel::signals::Sink;
use tofsim::kernel::{Thermometer, Time};
use tofsim::sim::array_device::ArrayDevice;
use tofsim::sim::array_device::trace::ArrayProbe;
use tofsim::sim::device::SignalProbe;
use tofsim::sim::frames::Frames;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
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
    array: Option<Arc<ArraySetup>>,
    /// Frames, or images of an array.
    frames: Option<u64>,
}

/// Creates a source that simulates `frames` frames or, without a number, as many as are read; with an array, images
/// of it, whose setup with the firmware is `setup`.
pub(super) fn source(setup: Setup, array: Option<ArraySetup>, frames: Option<u64>) -> Source {
    let mut entries = hierarchy::entries(&setup.params);
    if entries.iter().any(|entry| entry.scope == "tof_top.histogram_builder") {
        entries.extend(hierarchy::ram_entries(&setup.params.histogram));
    }
    entries.extend(hierarchy::column_entries(&setup.params));
    let signals = entries.iter().map(|entry| Signal {
        name: Name::new(entry.path()),
        scopes: entry.scope.split('.').map(str::to_owned).collect(),
        own: entry.signal.name.to_string(),
        width: entry.signal.width,
        lsb: 0,
        range: (entry.signal.width > 1).then(|| [i64::from(entry.signal.width) - 1, 0]),
        kind: SignalKind::Bits,
        words: Words::default(),
        description: None,
        radix: None,
        shape: Some(entry.signal.format),
        id: entry.id,
    });
    let (name, axis) = (format!("scenario {}", setup.name), Axis::Time(Tick::FEMTOSECOND));
    let origin = SimulationOrigin { setup: Arc::new(setup), array: array.map(Arc::new), frames };
    Source::new(name, SourceFormat::Simulation, axis, signals.collect(), origin)
}

impl signals::Origin for SimulationOrigin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let SimulationOrigin { setup, array, frames } = self.clone();
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
            let end = match array {
                None => Run::new(&setup).traced(frames, &mut probe, None)?.end,
                Some(array) => array.traced(frames, &mut probe, None)?.end,
            };
            // That nobody listens any more is no fault.
            let _ = feed.at(end.fs());
            Ok(())
        }))
    }

    fn searched(&self) -> Result<Option<u64>> {
        if self.frames.is_some() {
            return Ok(None);
        }
        if let Some(array) = &self.array {
            let timing = array.timing()?;
            let first = self.setup.pll().clk_sys.rise(timing.image + timing.latency);
            return Ok(Some(first.fs()));
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

impl ArrayProbe for ChangeFeed<'_> {
    fn begin(&mut self, device: &ArrayDevice) {
        self.sample(Time::ZERO, &device.top);
    }

    fn is_done(&self, _: &ArrayDevice) -> bool {
        self.gone
    }
}
