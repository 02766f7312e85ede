//! Depth images of an array in place of a single pixel's run.

use std::collections::BTreeMap;
use std::mem;
use std::sync::Arc;

use tofsim::error::{Error, Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::image::{ImageFidelity, simulate};
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

use crate::options::{Fidelity, Options};

use super::awaited::Awaited;
use super::clock::Clock;

mod actions;
mod command;
mod simulation;
mod source;
mod view;
mod worker;

use view::{ImageView, SummaryView};
use worker::{Outcome, Worker};

/// The images of an array, simulated one after the other by a thread of their own.
pub struct ImageSession {
    options: Options,
    /// Scenario as loaded at the start, and as it is now.
    base: Loaded,
    present: Loaded,
    /// Changes of the scene, by key.
    scene: BTreeMap<String, f64>,
    /// What all pixels have in common, at the start.
    common: Setup,
    size: [usize; 2],
    fidelity: Fidelity,
    /// Image rate of the firmware, if it can scan the array [1/s].
    firmware_images_per_s: Option<f64>,
    worker: Worker,
    /// Whether the next image is the first one of the present scenario.
    begins: bool,
    /// Number of restarts.
    restarts: u64,
    image: Option<Shown>,
    clock: Clock,
    running: bool,
    awaited: Awaited,
    fault: Option<String>,
    version: u64,
}

/// The last image.
struct Shown {
    summary: SummaryView,
    notes: Arc<[String]>,
    /// The image as JSON.
    json: Arc<str>,
}

impl ImageSession {
    /// Prepares the images of a scenario with an array.
    ///
    /// # Errors
    /// If the scenario cannot be simulated, or the fidelity does not apply.
    pub fn new(options: Options) -> Result<Self> {
        let base = options.load(&[])?;
        let fidelity = options.fidelity(&base)?;
        let array = ArraySetup::new(base.clone())?;
        if fidelity.of_images() == ImageFidelity::Histograms {
            simulate(&array.pixel(0, 0), ImageFidelity::Histograms, 0, None, None)?;
        }
        let cycle_s = array.common().cycle().seconds();
        let timing = array.timing().ok();
        Ok(ImageSession {
            present: base.clone(),
            base,
            scene: BTreeMap::new(),
            common: array.common().clone(),
            size: array.size(),
            fidelity,
            firmware_images_per_s: timing.map(|timing| 1.0 / (timing.image as f64 * cycle_s)),
            worker: Worker::start(fidelity.of_images())?,
            begins: true,
            restarts: 0,
            image: None,
            clock: Clock::default(),
            running: !options.stopped,
            awaited: Awaited::default(),
            fault: None,
            version: 0,
            options,
        })
    }

    /// Takes what the thread has come to; returns whether an image has ended.
    fn take(&mut self, Outcome { image, busy }: Outcome) -> bool {
        if self.begins {
            // It is of the scenario before.
            return false;
        }
        self.clock.busy += busy;
        match image {
            Ok(image) => {
                let command =
                    command::of_images(&self.options, &self.scene, self.fidelity, image.number + 1);
                let summary = SummaryView::of(&image, self.size, self.restarts, command);
                let json = ImageView::of(&image, &summary, self.size).json();
                self.image = Some(Shown { summary, notes: image.notes, json });
                self.clock.frame();
                if self.awaited.count() {
                    self.running = false;
                }
                true
            }
            Err(Error::Interrupted) => false,
            Err(error) => {
                let fault = error.to_string();
                self.awaited.end(Err(Input::new("run", &fault).into()));
                self.fault = Some(fault);
                self.stop();
                true
            }
        }
    }

    /// Has the thread simulate, if it does not.
    fn keep_busy(&mut self) {
        if !self.worker.is_busy() {
            let begin = mem::take(&mut self.begins).then(|| self.present.clone());
            self.worker.simulate(begin);
        }
    }
}
