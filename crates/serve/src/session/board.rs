//! A board's frames in place of a simulated run.

use std::sync::Arc;

use tofsim::error::{Input, Result};
use tofsim::firmware::registers::map;
use tofsim::firmware::tof_top::Pins;
use tofsim::kernel::U;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_board::Board;

use crate::options::Options;

use super::causes::unknown;
use super::clock::Clock;
use super::instrument::Instrument;
use super::request::{ControlRequest, RunRequest, changed};
use super::strip::Strip;
use super::view::{FrameView, RateView};

mod source;

/// The frames of a board. The laser is armed only while `laser_en` is set and frames are taken.
pub struct BoardSession {
    instrument: Instrument,
    board: Board,
    /// Number of the board's last finished frame plus one.
    before: u32,
    done: u64,
    /// Control signals.
    pins: Pins,
    frame: Option<FrameView>,
    frame_notes: Vec<String>,
    strip: Strip,
    clock: Clock,
    rates: Vec<RateView>,
    running: bool,
    /// Frames that a request waits for, in all and that have ended.
    batch: Option<(u32, u32)>,
    batch_end: Option<Result<()>>,
    fault: Option<String>,
    version: u64,
}

impl BoardSession {
    /// Opens the board, with the laser off and frames held back.
    ///
    /// # Errors
    /// If the board does not answer, or has other parameters than the scenario.
    pub fn new(options: Options) -> Result<Self> {
        let setup = Arc::new(Setup::new(options.load(&[])?)?);
        let port = options.board.board.as_deref().unwrap_or_default();
        let port = options.board.port(port);
        let mut board = Board::open(&port, &setup, options.board.any_parameters)?;
        board.prepare(&setup, false)?;
        let before = board.begin_frames()?;
        board.release()?;
        let cycle_s = setup.cycle().seconds();
        let rate = |&cycles: &u64| RateView { cycles, mhz: 1e-6 / (cycles as f64 * cycle_s) };
        let firmware = &setup.scenario.firmware;
        let (mode, laser_freq) = (u64::from(firmware.mode) == 1, U::new(firmware.laser_freq));
        Ok(BoardSession {
            rates: setup.params.vcsel_driver.periods.iter().map(rate).collect(),
            instrument: Instrument::new(setup)?,
            board,
            before,
            done: 0,
            pins: Pins { mode, laser_freq, dsp_en: true, ..Pins::default() },
            frame: None,
            frame_notes: Vec::new(),
            strip: Strip::default(),
            clock: Clock::default(),
            running: !options.stopped,
            batch: None,
            batch_end: None,
            fault: None,
            version: 0,
        })
    }

    fn setup(&self) -> &Setup {
        &self.instrument.setup
    }

    fn held(&self) -> Option<&'static str> {
        match self.pins {
            Pins { dsp_rst: true, .. } => Some("dsp_rst is high: Clear begins again and again"),
            Pins { dsp_en: false, .. } => {
                Some("dsp_en is low: the histogram waits for the estimator")
            }
            _ => None,
        }
    }

    fn run(&mut self, request: &RunRequest) -> Result<()> {
        request.check()?;
        if let Some((frames, done)) = self.batch {
            let expected = format!("stopped by another request after {done} of {frames} frames");
            self.end_batch(Err(Input::new("run", expected).into()));
        }
        if request.power_up {
            self.stop()?;
            let setup = Arc::clone(&self.instrument.setup);
            self.board.prepare(&setup, false)?;
            self.before = self.board.begin_frames()?;
            self.board.release()?;
            (self.frame, self.fault, self.done) = (None, None, 0);
            self.frame_notes.clear();
            self.strip.clear();
            self.pins = Pins { laser_en: false, dsp_en: true, dsp_rst: false, ..self.pins };
        }
        match request.running {
            Some(true) if self.fault.is_none() => self.start()?,
            Some(true) => {}
            Some(false) => self.stop()?,
            None => {}
        }
        if let Some(frames) = request.frames {
            if let Some(fault) = &self.fault {
                return Err(Input::new("run", fault).into());
            }
            self.start()?;
            self.batch = Some((frames, 0));
        }
        Ok(())
    }

    /// Takes frames, with the laser if it is switched on.
    fn start(&mut self) -> Result<()> {
        if self.pins.laser_en && !self.running {
            self.board.arm()?;
        }
        self.running = true;
        Ok(())
    }

    /// Takes no more frames; the laser is switched off.
    fn stop(&mut self) -> Result<()> {
        self.running = false;
        self.clock.stop();
        self.switch_laser(false)
    }

    fn switch_laser(&mut self, on: bool) -> Result<()> {
        self.pins.laser_en = false;
        self.board.set_control(map::LASER_EN, on.into())?;
        if on && self.running {
            self.board.arm()?;
        } else {
            self.board.write(&map::ARM, 0)?;
        }
        self.pins.laser_en = on;
        Ok(())
    }

    fn control(&mut self, request: &ControlRequest) -> Result<()> {
        let change = request.change(self.rates.len())?;
        let pins = changed(&self.pins, &change);
        let fields = [
            (map::LASER_FREQ, self.pins.laser_freq != pins.laser_freq, pins.laser_freq.get()),
            (map::MODE, self.pins.mode != pins.mode, pins.mode.into()),
            (map::DSP_EN, self.pins.dsp_en != pins.dsp_en, pins.dsp_en.into()),
            (map::DSP_RST, self.pins.dsp_rst != pins.dsp_rst, pins.dsp_rst.into()),
        ];
        for (field, _, value) in fields.iter().filter(|(_, has_changed, _)| *has_changed) {
            self.board.set_control(*field, *value as u32)?;
        }
        let lit = self.pins.laser_en;
        self.pins = Pins { laser_en: lit, ..pins };
        if pins.laser_en != lit {
            self.switch_laser(pins.laser_en)?;
        }
        if request.pulse_dsp_rst {
            self.board.release()?;
            self.pins.dsp_rst = false;
        }
        Ok(())
    }

    fn step(&mut self) -> Result<()> {
        if self.pins.laser_en {
            self.board.check_armed()?;
        }
        let setup = Arc::clone(&self.instrument.setup);
        let mut frame = self.board.next_frame(&setup, (self.done, self.before), None)?;
        self.before = self.before.wrapping_add(1);
        self.done += 1;
        // What the registers do not have is as long as it always is.
        let period = setup.params.vcsel_driver.period(self.pins.laser_freq);
        frame.laser_en = self.pins.laser_en;
        frame.tdc_hits = frame.hits();
        frame.estimator_cycles = setup.params.estimator_cycles();
        frame.frame_cycles = setup.frame_cycles(period);
        self.take_frame(&frame);
        Ok(())
    }

    fn take_frame(&mut self, frame: &Frame) {
        let depths = self.instrument.depths(frame);
        self.strip.push(frame.index, None, &depths, None);
        let notes = self.instrument.notes_of(frame);
        self.frame_notes = notes.iter().map(ToString::to_string).collect();
        self.frame = Some(FrameView {
            layers: unknown(frame),
            causes_seen: true,
            depths,
            ..FrameView::of(frame, self.setup(), false)
        });
        self.clock.frame();
    }

    fn end_batch(&mut self, outcome: Result<()>) {
        if self.batch.take().is_some() {
            self.batch_end = Some(outcome);
            self.running = false;
        }
    }
}
