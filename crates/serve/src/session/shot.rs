//! The waveform of a shot of the last frame, from simulating that frame once more.

use std::fs;
use std::sync::Arc;

use tofsim::error::{Error, Input, Result};
use tofsim::hierarchy;
use tofsim::scenario::Control;
use tofsim::sim::Live;
use tofsim::sim::setup::Setup;
use tofsim::{WaveFormat, Window};

/// What the page draws of a shot, as far as the design has it.
const VIEW: [&str; 16] = [
    "clk_sys",
    "pre_start",
    "spad_rst",
    "start",
    "laser_on",
    "tdc_stop",
    "tdc.coarse_counter.window",
    "tdc.coarse_counter.coarse",
    "tdc.tdc_latch.hit",
    "tdc.tdc_latch.hit_coarse",
    "tdc.tdc_decoder.n_valid",
    "tdc.tdc_decoder.n",
    "tdc_valid",
    "tdc_code",
    "histogram_builder.writing",
    "histogram_builder.hit_word",
];

/// The name by which a browser asks for those.
pub const VIEW_NAME: &str = "view";

/// A frame at its begin, and what has been done to it since.
#[derive(Clone)]
pub struct Keyframe {
    live: Live,
    changes: Vec<Control>,
}

/// Changes that are kept of a frame; its waveform cannot be had after more.
const MOST_CHANGES: usize = 4096;

impl Keyframe {
    /// As a frame begins.
    pub fn new(live: &Live) -> Self {
        Keyframe { live: live.clone(), changes: Vec::new() }
    }

    /// The scene changes, in Clear.
    pub fn change_scene(&mut self, setup: &Arc<Setup>) {
        self.live.change_scene(Arc::clone(setup));
    }

    /// A control signal changes.
    pub fn change(&mut self, change: &Control) {
        if self.changes.len() <= MOST_CHANGES {
            self.changes.push(change.clone());
        }
    }
}

/// A frame that is over.
#[derive(Clone)]
pub struct Finished {
    keyframe: Keyframe,
    /// Shots from its begin to its end.
    shots: u64,
    /// Its length [cycles of clk_sys].
    cycles: u64,
}

impl Finished {
    /// The frame that began with `keyframe` and has just ended.
    pub fn new(keyframe: Keyframe, live: &Live) -> Self {
        let shots = live.shots() - keyframe.live.shots();
        let cycles = live.device().cycle() - keyframe.live.device().cycle();
        Finished { keyframe, shots, cycles }
    }

    /// The waveform of a shot, by its number in the frame, or of the last one; of the signals that match one of
    /// the globs, or of all.
    ///
    /// # Errors
    /// When the frame has no such shot, or a glob matches no signal.
    pub fn waves(
        &self,
        shot: Option<u64>,
        format: WaveFormat,
        globs: &[String],
    ) -> Result<Vec<u8>> {
        let fault = |expected: String| Input::new("shot", expected);
        if self.keyframe.changes.len() > MOST_CHANGES {
            let expected = "the control signals have changed too often in this frame";
            return Err(fault(expected.to_owned()).into());
        }
        let last = self.shots.checked_sub(1);
        let last = last.ok_or_else(|| fault("the last frame has no shots".to_owned()))?;
        let shot = shot.unwrap_or(last);
        if shot > last {
            return Err(fault(format!("expected 0 to {last}")).value(shot).into());
        }
        let mut live = self.keyframe.live.clone();
        self.keyframe.changes.iter().for_each(|change| live.repeat(change));
        let setup = Arc::clone(live.setup());
        let from = live.shots() + shot;
        let globs = if globs == [VIEW_NAME] { view(&setup) } else { globs.to_vec() };
        let globs: Vec<_> = globs.iter().map(String::as_str).collect();
        let folder = tempfile::tempdir().map_err(Error::io(&std::env::temp_dir(), "create"))?;
        let path = folder.path().join("shot");
        let waves = setup.waves(&path, format, &globs)?;
        live.trace(waves, vec![Window::Shots { from, to: from + 1 }], self.cycles)?;
        fs::read(&path).map_err(Error::io(&path, "read"))
    }
}

/// Those of [`VIEW`] that the design has.
fn view(setup: &Setup) -> Vec<String> {
    let known: Vec<_> =
        hierarchy::entries(&setup.params).iter().map(|entry| entry.below_top()).collect();
    let known = |name: &str| known.iter().any(|known| *known == name);
    let names = VIEW.iter().filter(|name| known(name));
    names.map(|name| format!("{}.{name}", hierarchy::TOP)).collect()
}
