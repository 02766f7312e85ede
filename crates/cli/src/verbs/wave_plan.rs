//! The waveform of a verb: what goes into it, and where.

use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::hierarchy::Entry;
use tofsim::scenario::window::Window;
use tofsim::sim::setup::Setup;
use tofsim::waves::{Marks, WaveFormat, Waves, write_views};

use crate::record::Record;

/// Folder of waveforms unless another one is named.
const FOLDER: &str = "waves";

/// Parts of a run and signals for the waveform.
#[derive(Clone, Debug, clap::Args)]
pub struct SignalArgs {
    /// Part of the run to record in the waveform: shot:0..8, shot:100, 10us..12us or estimation; may be repeated [default: the
    /// scenario's, or shot:0..16 and estimation]
    #[arg(long, value_name = "W", value_parser = str::parse::<Window>)]
    pub window: Vec<Window>,
    /// Signals to record in the waveform, by name or path with * and ?; may be repeated [default: all but the
    /// histogram's RAM]
    #[arg(long, value_name = "GLOB")]
    pub signals: Vec<String>,
}

impl SignalArgs {
    /// Returns the options that are given, by name.
    pub fn given(&self) -> [(&'static str, bool); 2] {
        [("--window", !self.window.is_empty()), ("--signals", !self.signals.is_empty())]
    }
}

/// The waveform: what goes into it, and where.
pub struct WavePlan {
    /// File of the waveform.
    pub path: PathBuf,
    format: WaveFormat,
    entries: Vec<Entry>,
    windows: Vec<Window>,
}

impl WavePlan {
    /// Plans the waveform of a setup in a folder, or in that of waveforms.
    ///
    /// # Errors
    /// When a glob matches no signal.
    pub fn new(
        (folder, format): (Option<&Path>, WaveFormat),
        setup: &Setup,
        signals: &[String],
        windows: Vec<Window>,
    ) -> Result<Self> {
        let ending = match format {
            WaveFormat::Vcd => "vcd",
            WaveFormat::Fst => "fst",
        };
        let entries = setup.entries(signals)?;
        let folder = folder.unwrap_or(Path::new(FOLDER));
        let path = folder.join(format!("{}.{ending}", setup.name));
        Ok(WavePlan { path, format, entries, windows })
    }

    /// Begins the file.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn open(&self, record: &Record, setup: &Setup) -> Result<(Waves, Vec<Window>)> {
        let (encoder, provenance) = (&setup.params.tdc.decoder.encoder, record.lines(setup));
        let waves = Waves::create(&self.path, self.format, &self.entries, encoder, &provenance)?;
        Ok((waves, self.windows.clone()))
    }

    /// Writes what viewers need beside the waveform, and returns all paths.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn finish(&self, marks: &Marks) -> Result<Vec<PathBuf>> {
        let views = write_views(&self.path, self.format, &self.entries, marks)?;
        Ok([self.path.clone()].into_iter().chain(views).collect())
    }
}
