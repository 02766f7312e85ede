//! Simulators to compare.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Serialize;
use tofsim::scenario;
use tofsim::sim::setup::Setup;

use crate::run::{self, Output};
use crate::{Expected, Result};

/// Default number of shots per frame.
pub const SHOTS: u64 = 30_000;
/// Number of shots of a short frame.
pub const FEW_SHOTS: u64 = 300;

/// Kind of work to time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// A frame, simulating every cycle.
    Cycle,
    /// A frame, skipping cycles without an event.
    CycleSkip,
    /// A frame, shot by shot.
    Shot,
    /// A frame's histogram, and the depth from it.
    Histogram,
    /// A frame with a VCD of every signal, to the null device.
    Vcd,
    /// A frame with an FST of every signal, to a file.
    Fst,
}

impl Work {
    /// All kinds, in the order of the report.
    pub const ALL: [Work; 6] =
        [Work::Cycle, Work::CycleSkip, Work::Shot, Work::Histogram, Work::Vcd, Work::Fst];

    /// Returns its name in the report.
    pub fn name(self) -> &'static str {
        match self {
            Work::Cycle => "cycle",
            Work::CycleSkip => "cycle_skip",
            Work::Shot => "shot",
            Work::Histogram => "histogram",
            Work::Vcd => "vcd",
            Work::Fst => "fst",
        }
    }

    /// Returns the kind of work of a peer with which to compare.
    pub fn of_peer(self) -> Work {
        match self {
            Work::Vcd | Work::Fst => self,
            _ => Work::Cycle,
        }
    }

    /// Returns the path of its waveform, if it writes one.
    pub fn waveform(self, folder: &Path) -> Option<PathBuf> {
        match self {
            Work::Vcd => Some(PathBuf::from("/dev/null")),
            Work::Fst => Some(folder.join("waveform.fst")),
            _ => None,
        }
    }
}

/// Method of running a peer.
#[derive(Clone, Debug)]
pub enum Call {
    /// A driver with the arguments and output of `protocol.h`.
    Driver(PathBuf),
    /// `vvp` with the given file.
    Vvp(PathBuf),
}

/// A peer.
#[derive(Clone, Debug)]
pub struct Contender {
    /// Name of the simulator.
    pub simulator: &'static str,
    /// Sources and driver.
    pub variant: &'static str,
    /// Kind of work.
    pub work: Work,
    /// Method of running it.
    pub call: Call,
    /// Number of frames per timing.
    pub frames: u64,
    /// Number of shots per frame.
    pub shots: u64,
    /// Whether a run takes seconds, and has fewer rounds.
    pub is_slow: bool,
}

impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.simulator, self.variant)?;
        if self.shots != SHOTS {
            write!(f, ", frames of {} shots, scaled", self.shots)?;
        }
        Ok(())
    }
}

impl Contender {
    /// Runs a number of frames.
    pub fn run(&self, context: &Context, frames: u64) -> Result<Output> {
        let waveform = self.work.waveform(&context.folder);
        match &self.call {
            Call::Driver(path) => {
                let mut command = Command::new(path);
                command.args([context.laser_freq.to_string(), frames.to_string()]);
                command.arg(&context.photons).args(waveform);
                run::driver(command.current_dir(&context.root))
            }
            Call::Vvp(path) => run::vvp(&mut context.vvp(path, frames)),
        }
    }

    /// Times the peer, and checks its results [ms per frame of 30,000 shots].
    pub fn time(&self, context: &Context) -> Result<f64> {
        let output = self.run(context, self.frames)?;
        let expected = context.expected(self.shots);
        expected.check(&output.frames).map_err(|fault| format!("{self}: {fault}"))?;
        let scale = context.expected(SHOTS).period as f64 / expected.period as f64;
        Ok(output.seconds * 1e3 * scale / self.frames as f64)
    }
}

/// Settings shared by all runs at one laser rate.
pub struct Context {
    /// Folder to which the ROMs' paths are relative.
    pub root: PathBuf,
    /// Folder of output files.
    pub folder: PathBuf,
    /// Laser repetition rate.
    pub laser_freq: u8,
    /// Setup of tofsim.
    pub setup: Setup,
    /// Photons of a frame: a line for each shot, the time from the laser edge or -1 [fs].
    pub photons: PathBuf,
    /// Expected results, by shots per frame.
    expected: BTreeMap<u64, Expected>,
}

impl Context {
    /// Runs tofsim for the photons and the expected results.
    pub fn new(root: &Path, folder: &Path, laser_freq: u8) -> Result<Self> {
        let (root, folder) = (root.to_path_buf(), folder.to_path_buf());
        let photons = folder.join(format!("photons_{laser_freq}.txt"));
        let mut expected = BTreeMap::new();
        for shots in [FEW_SHOTS, SHOTS] {
            expected.insert(shots, Expected::of(&set_up(laser_freq, shots)?, &photons)?);
        }
        let setup = set_up(laser_freq, SHOTS)?;
        Ok(Context { root, folder, laser_freq, setup, photons, expected })
    }

    /// Returns the expected results of frames with `shots` shots.
    pub fn expected(&self, shots: u64) -> &Expected {
        &self.expected[&shots]
    }

    fn vvp(&self, path: &Path, frames: u64) -> Command {
        let mut command = Command::new("vvp");
        command.arg("-n").arg(path).current_dir(&self.root);
        command.arg(format!("+freq={}", self.laser_freq)).arg(format!("+frames={frames}"));
        command.arg(format!("+photons={}", self.photons.display()));
        command
    }
}

fn set_up(laser_freq: u8, shots: u64) -> Result<Setup> {
    let overrides =
        [format!("firmware.laser_freq={laser_freq}"), format!("firmware.shots_per_frame={shots}")];
    Ok(Setup::new(scenario::load(scenario::DEFAULT, &overrides)?)?)
}
