//! Waveform of a shot of the last frame, made by simulating the frame again.

use std::fs;
use std::sync::Arc;

use tofsim::error::{Error, Input, Result};
use tofsim::hierarchy;
use tofsim::scenario::Control;
use tofsim::sim::Live;
use tofsim::sim::setup::Setup;
use tofsim::{WaveFormat, Window};

/// Signals of a shot that the page draws, if they exist in the design.
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

/// Name by which a browser requests these signals.
pub const VIEW_NAME: &str = "view";

/// State at the start of a frame, with all changes since then.
#[derive(Clone)]
pub struct Keyframe {
    live: Live,
    changes: Vec<Control>,
}

/// Largest number of changes that are kept; after more, the waveform is unavailable.
const MOST_CHANGES: usize = 4096;

impl Keyframe {
    /// Copies the state at the start of a frame.
    pub fn new(live: &Live) -> Self {
        Keyframe { live: live.clone(), changes: Vec::new() }
    }

    /// Registers a change of the scene, in the state Clear.
    pub fn change_scene(&mut self, setup: &Arc<Setup>) {
        self.live.change_scene(Arc::clone(setup));
    }

    /// Registers a change of control signals.
    pub fn change(&mut self, change: &Control) {
        if self.changes.len() <= MOST_CHANGES {
            self.changes.push(change.clone());
        }
    }
}

/// A complete frame.
#[derive(Clone)]
pub struct Finished {
    keyframe: Keyframe,
    /// Number of shots.
    shots: u64,
    /// Its length [cycles of clk_sys].
    cycles: u64,
}

impl Finished {
    /// Creates the frame that began with `keyframe` and has just ended.
    pub fn new(keyframe: Keyframe, live: &Live) -> Self {
        let shots = live.shots() - keyframe.live.shots();
        let cycles = live.device().cycle() - keyframe.live.device().cycle();
        Finished { keyframe, shots, cycles }
    }

    /// Simulates the frame again, and returns the waveform of a shot, by its number or the last one, with the signals
    /// that match one of the globs, or all.
    ///
    /// # Errors
    /// If the frame has no such shot, or a glob matches no signal.
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

/// Returns the signals of [`VIEW`] that exist in the design.
fn view(setup: &Setup) -> Vec<String> {
    let known: Vec<_> =
        hierarchy::entries(&setup.params).iter().map(|entry| entry.below_top()).collect();
    let known = |name: &str| known.iter().any(|known| *known == name);
    let names = VIEW.iter().filter(|name| known(name));
    names.map(|name| format!("{}.{name}", hierarchy::TOP)).collect()
}
