//! Runs a device for a number of frames, and hands on what it shows.

use std::sync::atomic::AtomicBool;

use crate::error::{Error, Input, Result, poll_stop};
use crate::firmware::tof_top::Pins;
use crate::kernel::Time;
use crate::note::Note;
use crate::scenario::window::Window;
use crate::waves::{Marks, Waves};

use super::callback::{Callback, call};
use super::clockwork::{Clockwork, Event};
use super::device::Off;
use super::frames::Frame;
use super::recordings::Recordings;
use super::setup::Setup;
use super::shot_recorder::{Shot, ShotListener};
use super::stepping::Stepping;
use super::transactions::Transaction;
use super::wave_tracer::{WaveTracer, WindowedProbe};

/// Cycles between two polls of whether to stop, a part of a second.
pub(super) const POLL_INTERVAL: u64 = 1 << 18;

/// Observers of a run, and the flag that stops it.
#[derive(Default)]
pub struct Observers<'a> {
    /// The waveform, and the parts of the run that go into it.
    pub waves: Option<(Waves, Vec<Window>)>,
    /// Receives each shot, in order.
    pub shots: Option<Callback<'a, Shot>>,
    /// Receives each transaction, as they end.
    pub transactions: Option<Callback<'a, Transaction>>,
    /// Receives each frame, in order, after its shots.
    pub frames: Option<Callback<'a, Frame>>,
    /// Set from outside to stop the run.
    pub stop: Option<&'a AtomicBool>,
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// When it ended.
    pub end: Time,
    /// Edges of `clk_sys` simulated.
    pub cycles: u64,
    /// Shots begun.
    pub shots: u64,
    /// Where to look in the waveform.
    pub marks: Marks,
    /// Inputs that the run ended before.
    pub notes: Vec<Note>,
}

/// A run in progress.
#[derive(Clone)]
pub struct Run<'a> {
    pub(super) setup: &'a Setup,
    pub(super) clockwork: Clockwork,
    /// Only a run that never ends goes past it [cycles of clk_sys].
    pub(super) limit: u64,
}

impl<'a> Run<'a> {
    /// A run of `setup` from power-up, which skips idle cycles where nobody looks at them.
    pub fn new(setup: &'a Setup) -> Self {
        let stepping = Stepping::default().at_most(setup);
        Run { setup, clockwork: Clockwork::new(setup.device(), stepping), limit: 0 }
    }

    /// Sets the fidelity for when nobody looks at signals or shots; the results are the same.
    pub fn stepping(mut self, stepping: Stepping) -> Self {
        self.clockwork.fast.stepping = stepping.at_most(self.setup);
        self
    }

    /// Simulates `count` frames and returns them.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending.
    pub fn frames(self, count: u64) -> Result<Vec<Frame>> {
        let mut frames = Vec::new();
        let mut take = |frame: &Frame| {
            frames.push(frame.clone());
            Ok(())
        };
        self.observe(count, Observers { frames: Some(&mut take), ..Observers::default() })?;
        Ok(frames)
    }

    /// Simulates until `count` frames are done, and shows the observers what they ask for.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, a window lies past the end, an observer
    /// fails, or the run is stopped.
    pub fn observe(mut self, count: u64, observers: Observers) -> Result<Outcome> {
        let Observers { waves, shots, transactions, frames, stop } = observers;
        let recordings = Recordings::of(shots, transactions);
        let Some((waves, windows)) = waves else {
            self.follow(count, &mut Off, recordings, frames, stop)?;
            return Ok(self.outcome(Marks::default()));
        };
        let mut tracer = WaveTracer::new(waves, windows);
        self.follow(count, &mut tracer, recordings, frames, stop)?;
        let end = self.clockwork.device.next_edge();
        let marks = tracer.finish(end, self.clockwork.frames.shots())?;
        Ok(self.outcome(marks))
    }

    /// Simulates until `count` frames are done, or until `probe` is; it sees the signals whenever it
    /// wants to.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, `probe` fails, or the run is stopped.
    #[doc(hidden)]
    pub fn traced<T: WindowedProbe>(
        mut self,
        count: u64,
        probe: &mut T,
        stop: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        self.follow(count, probe, None, None, stop)?;
        Ok(self.outcome(Marks::default()))
    }

    /// Simulates from power-up until `count` frames are done.
    fn follow<T: WindowedProbe>(
        &mut self,
        count: u64,
        probe: &mut T,
        recordings: Option<Recordings>,
        mut frames: Option<Callback<Frame>>,
        stop: Option<&AtomicBool>,
    ) -> Result<()> {
        self.limit = self.setup.longest_run(count);
        let device = &mut self.clockwork.device;
        if probe.begins_at_power_up(device) {
            device.power_up(probe, &mut Off);
        } else {
            device.power_up(&mut Off, &mut Off);
        }
        let Some(mut recordings) = recordings else {
            return self.go(count, probe, &mut Off, &mut frames, stop);
        };
        self.go(count, probe, &mut recordings, &mut frames, stop)?;
        recordings.finish(self.clockwork.device.next_edge())
    }

    /// Simulates until `count` frames are done, one at least, or until `probe` is.
    pub(super) fn go<T: WindowedProbe, S: ShotListener>(
        &mut self,
        count: u64,
        probe: &mut T,
        shots: &mut S,
        frames: &mut Option<Callback<Frame>>,
        stop: Option<&AtomicBool>,
    ) -> Result<()> {
        while let Some(frame) = self.next_frame(probe, shots, stop)? {
            call(frames, &frame)?;
            if self.clockwork.frames.done() >= count {
                break;
            }
        }
        Ok(())
    }

    /// Simulates until a frame has ended; `None` if `probe` is done before.
    pub(super) fn next_frame<T: WindowedProbe, S: ShotListener>(
        &mut self,
        probe: &mut T,
        shots: &mut S,
        stop: Option<&AtomicBool>,
    ) -> Result<Option<Frame>> {
        let mut next_poll = self.clockwork.cycle();
        loop {
            match self.clockwork.advance(&self.setup.params, next_poll, probe, shots)? {
                Event::FrameEnd(frame) => return Ok(Some(frame)),
                Event::Restart => {}
                Event::Paused if probe.is_done() => return Ok(None),
                Event::Paused => {
                    poll_stop(stop)?;
                    let cycle = self.clockwork.cycle();
                    if cycle > self.limit {
                        let Clockwork { device, frames, .. } = &self.clockwork;
                        return Err(never_ends(self.setup, &device.top.pins, frames.done()));
                    }
                    next_poll = cycle + POLL_INTERVAL;
                }
            }
        }
    }

    pub(super) fn outcome(mut self, marks: Marks) -> Outcome {
        let Clockwork { device, frames, .. } = &mut self.clockwork;
        let (end, cycles, shots) = (device.next_edge(), device.cycle(), frames.shots());
        Outcome { end, cycles, shots, marks, notes: device.unused() }
    }
}

/// Returns the error that the control signals keep frame `done` from ending, and which of them does.
pub(super) fn never_ends(setup: &Setup, pins: &Pins, done: u64) -> Error {
    let (pin, held) = match (pins.rst, pins.dsp_rst, pins.dsp_en) {
        (true, ..) => ("rst", "stays high"),
        (_, true, _) => ("dsp_rst", "stays high"),
        (.., false) => ("dsp_en", "stays low"),
        _ => ("control", "begins it again and again"),
    };
    let changes = setup.scenario.control.iter().rposition(|change| match pin {
        "rst" => change.rst.is_some(),
        "dsp_rst" => change.dsp_rst.is_some(),
        _ => change.dsp_en.is_some(),
    });
    let field = match changes {
        Some(last) => format!("control.{last}.{pin}"),
        None => format!("firmware.{pin}"),
    };
    let expected = format!("frame {done} never ends: {pin} {held}");
    Input::new(format!("scenario {}", setup.name), expected).field(field).into()
}
