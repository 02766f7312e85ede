//! Requests that act on the images.

use std::collections::BTreeMap;

use tofsim::error::{Input, Result};
use tofsim::scenario::Loaded;

use crate::session::clock::Clock;
use crate::session::request::RunRequest;
use crate::session::scene;

use super::ImageSession;

impl ImageSession {
    pub(super) fn run(&mut self, request: &RunRequest) -> Result<()> {
        request.check()?;
        if self.awaited.interrupt("images") {
            self.running = false;
        }
        if request.power_up {
            self.restart(self.present.clone());
            self.image = None;
        }
        if let Some(running) = request.running {
            self.stop();
            self.running = running && self.fault.is_none();
        }
        if let Some(images) = request.frames {
            self.stop();
            if let Some(fault) = &self.fault {
                return Err(Input::new("run", fault).into());
            }
            self.awaited.begin(images);
            self.running = true;
        }
        Ok(())
    }

    /// Simulates no further; the image that is being simulated goes on from there.
    pub(super) fn stop(&mut self) {
        self.running = false;
        self.worker.interrupt();
        self.clock.stop();
    }

    pub(super) fn change_scene(&mut self, asked: BTreeMap<String, f64>) -> Result<()> {
        let mut scene = self.scene.clone();
        scene::lay_over(&mut scene, asked)?;
        let present = self.options.reload(&self.base, &scene::overrides(&scene))?;
        self.scene = scene;
        self.restart(present);
        Ok(())
    }

    /// Begins again with image 0 of a scenario.
    fn restart(&mut self, scenario: Loaded) {
        self.worker.abandon();
        self.present = scenario;
        self.begins = true;
        self.restarts += 1;
        self.fault = None;
        self.clock = Clock::default();
    }
}
