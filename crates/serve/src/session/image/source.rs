//! What browsers see of an array's images, and ask of them.

use std::sync::Arc;
use std::time::Duration;

use tofsim::error::{Input, Result};

use super::super::reply::Reply;
use super::super::request::Request;
use super::super::scene::sliders;
use super::super::source::Source;
use super::ImageSession;
use super::view::{ArrayView, ProgressView, SCHEMA, SizeView, TimeView};

/// Longest wait for an image before requests are answered.
const SLICE: Duration = Duration::from_millis(20);

impl Source for ImageSession {
    fn state(&mut self) -> Arc<str> {
        self.version += 1;
        let [rows, columns] = self.size;
        let image = self.image.as_ref().map(|shown| &shown.summary);
        let is_of_this_run = |number: u64| image.is_some_and(|image| image.restart == number);
        let images =
            image.filter(|_| is_of_this_run(self.restarts)).map_or(0, |image| image.number + 1);
        let view = ArrayView {
            schema: SCHEMA,
            version: self.version,
            scenario: &self.base.name,
            seed: self.base.scenario.seed,
            fidelity: self.fidelity.name(),
            estimator: self.common.params.estimator.estimator(),
            array: SizeView { rows, columns },
            running: self.running,
            fault: self.fault.as_deref(),
            scene: sliders(&self.common, &self.present.scenario),
            scene_coming: image.is_some() && !is_of_this_run(self.restarts),
            image,
            progress: ProgressView {
                pixels: if self.begins { 0 } else { self.worker.simulated() },
                of: rows * columns,
            },
            notes: self.image.as_ref().map_or(&[], |shown| &shown.notes),
            time: TimeView {
                images,
                images_per_s: self.clock.frames_per_second(),
                firmware_images_per_s: self.firmware_images_per_s,
                here_s: self.clock.busy.as_secs_f64(),
            },
        };
        serde_json::to_string(&view).unwrap_or_default().into()
    }

    fn answer(&mut self, request: Request) -> Result<Reply> {
        let refused = |what: &str, why: &str| {
            let expected = format!("expected a scenario of a single pixel: {why}");
            Err(Input::new(what, expected).into())
        };
        match request {
            Request::Run(request) => self.run(&request)?,
            Request::Scene(asked) => self.change_scene(asked)?,
            Request::State => {}
            Request::Image => {
                let none = || Input::new("image", "no image has ended yet");
                let shown = self.image.as_ref().ok_or_else(none)?;
                return Ok(Reply::Image(Arc::clone(&shown.json)));
            }
            Request::Control(_) => {
                let why = "the images of an array have the control signals of the keys firmware.*";
                return refused("control", why);
            }
            Request::Ila(_) | Request::IlaFile(_) => {
                return refused("ila", "arrays have no logic analyser");
            }
            Request::Shot { .. } => {
                let why = "`tofsim image --waves` writes the waveform of an array, `tofsim run --pixel` that of \
                           one of its pixels";
                return refused("shot", why);
            }
            Request::Scenario => {
                let why =
                    "the images of an array have a command that gives them again, image.command";
                return refused("run.toml", why);
            }
        }
        Ok(Reply::State(self.state()))
    }

    fn is_running(&self) -> bool {
        self.running
    }

    fn is_held(&self) -> bool {
        false
    }

    fn part_of_frame(&self) -> f64 {
        0.0
    }

    fn advance(&mut self, _: u64) -> bool {
        self.keep_busy();
        let outcome = self.worker.wait(SLICE);
        outcome.is_some_and(|outcome| self.take(outcome))
    }

    fn has_batch(&self) -> bool {
        self.awaited.is_waiting()
    }

    fn take_batch_end(&mut self) -> Option<Result<()>> {
        self.awaited.take_outcome()
    }
}
