//! What browsers see of a board, and ask of it.

use std::sync::Arc;
use std::time::Instant;

use tofsim::error::{Input, Result};
use tofsim::firmware::registers::map;
use tofsim::optics::budget::LIGHT_M_S;

use super::super::analyser::Ila;
use super::super::reply::Reply;
use super::super::request::{Request, no_image};
use super::super::source::Source;
use super::super::view::{BinsView, ControlView, ProgressView, SCHEMA, TimeView, View};
use super::BoardSession;

impl Source for BoardSession {
    fn state(&mut self) -> Arc<str> {
        self.version += 1;
        let setup = self.setup();
        let period = setup.params.vcsel_driver.period(self.pins.laser_freq);
        let cycles = setup.frame_cycles(period) as f64;
        let frame_s = cycles * setup.cycle().seconds();
        let bin_s = setup.scenario.tdc.bin_ps * 1e-12;
        let notes = self.instrument.notes.iter().map(ToString::to_string);
        let (done, shots) = (self.done, setup.shots(1));
        let view = View {
            schema: SCHEMA,
            version: self.version,
            scenario: &setup.name,
            seed: setup.scenario.seed,
            fidelity: "board",
            board: Some(self.board.port()),
            hash: &setup.hash(),
            running: self.running,
            fault: self.fault.as_deref(),
            held: self.held(),
            control: ControlView::of(&self.pins),
            rates: &self.rates,
            laser_fixed: None,
            scene: Vec::new(),
            scene_coming: false,
            scene_fixed: Some("it is the one in front of the board"),
            frame: self.frame.as_ref(),
            progress: ProgressView {
                frame: done,
                phase: "Acquire",
                shots: 0,
                of: shots,
                abandoned: 0,
            },
            strip: self.strip.points(),
            notes: notes.chain(self.frame_notes.iter().cloned()).collect(),
            time: TimeView {
                board_s: done as f64 * frame_s,
                here_s: self.clock.busy.as_secs_f64(),
                board_frames_per_s: 1.0 / frame_s,
                frames_per_s: self.clock.frames_per_second(),
                frames: done,
                shots: done * shots,
            },
            bins: BinsView {
                count: setup.params.histogram.bins,
                bin_m: bin_s * LIGHT_M_S / 2.0,
                first_m: setup.scenario.tdc.first_bin_ps * 1e-12 * LIGHT_M_S / 2.0,
            },
            ila: Ila::default().view(),
            set_ups: &[],
            exact: false,
        };
        serde_json::to_string(&view).unwrap_or_default().into()
    }

    fn answer(&mut self, request: Request) -> Result<Reply> {
        let refused = |what: &str, why: &str| Err(Input::new(what, why).into());
        match request {
            Request::Run(request) => self.run(&request)?,
            Request::Control(request) => self.control(&request)?,
            Request::State => {}
            Request::Image => return Err(no_image()),
            Request::Scene(_) => {
                return refused("scene", "the scene is the one in front of the board");
            }
            Request::Ila(_) | Request::IlaFile(_) => {
                return refused(
                    "ila",
                    "a board has no logic analyser but Vivado's: compare its captures",
                );
            }
            Request::Shot { .. } => return refused("shot", "a board's registers have no waveform"),
            Request::Scenario => {
                return refused("scenario", "a board's frames are no run to repeat");
            }
        }
        Ok(Reply::State(self.state()))
    }

    fn is_running(&self) -> bool {
        self.running
    }

    fn is_held(&self) -> bool {
        self.held().is_some()
    }

    fn part_of_frame(&self) -> f64 {
        0.0
    }

    fn advance(&mut self, _: u64) -> bool {
        let began = Instant::now();
        // A host that is heard keeps the laser armed.
        let ended = match self.held() {
            Some(_) => self.board.keep_alive().map(|()| false),
            None => self.step().map(|()| true),
        };
        self.clock.busy += began.elapsed();
        match ended {
            Ok(ended) => {
                let batch = self.batch.as_mut().filter(|_| ended);
                let is_last = batch.is_some_and(|(frames, done)| {
                    *done += 1;
                    done == frames
                });
                if is_last {
                    let disarmed = self.board.write(&map::ARM, 0);
                    self.end_batch(disarmed);
                }
                ended
            }
            Err(error) => {
                let fault = error.to_string();
                self.end_batch(Err(Input::new("run", &fault).into()));
                self.fault = Some(fault);
                // The board may be gone; its guard switches the laser off by itself.
                let _ = self.stop();
                true
            }
        }
    }

    fn has_batch(&self) -> bool {
        self.batch.is_some()
    }

    fn take_batch_end(&mut self) -> Option<Result<()>> {
        self.batch_end.take()
    }
}
