//! `tofsim calibrate glass`: the light of a cover window, from histograms without a target.

use std::path::PathBuf;

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode, Run};
use tofsim_learn::calibration::glass::GlassCalibration;
use tofsim_learn::estimation::Acquisition;

use crate::report::glass::GlassFindings;
use crate::report::writer::Report;
use crate::verbs::estimate::width;
use crate::verbs::options::ResultArgs;
use crate::verbs::terminal::Console;

use super::files::HistogramFiles;

/// Frames that are simulated if no files are given.
const FRAMES: u64 = 100;
/// Relative standard error of the template above which it is noted [1].
const COARSE: f64 = 0.01;
/// Change over the calibration that is noted, if it is five standard errors [1].
const CHANGED: f64 = 0.01;

/// Measure the light of a cover window, from histograms without a target
///
/// Take the target away and darken what is behind: the histograms, added up, give the window's light in each bin, with
/// standard errors. Ambient light is fitted and removed; a target is detected and refused. Without files the scenario
/// is simulated without its target. -o writes glass.csv for estimator.glass_file, glass.svg and calibration.json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim calibrate glass mine.npy --scenario mine.toml -o glass\n  \
    tofsim calibrate glass --frames 500 -s cover.fraction=1e-4 -o glass\n  \
    tofsim run --estimator likelihood -s estimator.glass_file=glass/glass.csv")]
pub(super) struct GlassArgs {
    /// Histograms: CSV with a row for each bin (bin,count, time_ns,count, time_ps,count or count), .npy of 256 or
    /// n x 256 whole numbers, or Parquet with columns b0 to b255 [default: simulate]
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Frames to simulate without the target [default: 100]
    #[arg(long, value_name = "N", conflicts_with_all = ["files", "bin_ps"],
          value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    frames: Option<u64>,
    /// Built-in scenario, or the path of a scenario file: shots and chain of the histograms
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `firmware.shots_per_frame=10000`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Bin width of histograms from another sensor, with any number of bins [ps]
    #[arg(long, value_name = "PS", value_parser = width, requires = "files")]
    bin_ps: Option<f64>,
    #[command(flatten)]
    result: ResultArgs,
}

impl GlassArgs {
    pub(super) fn run(&self, console: &Console) -> Result<()> {
        if self.files.is_empty() {
            let setup = without_target(scenario::load(&self.scenario, &self.set)?)?;
            let histograms = simulated(&setup, self.frames.unwrap_or(FRAMES))?;
            let bins = setup.known_bins();
            let acquisition = acquisition(&setup, &bins);
            let name = |number| ("simulated".to_owned(), number);
            let found = GlassCalibration::new(&acquisition, &histograms, name)?;
            return self.deliver(found, &setup, acquisition.shots, console);
        }
        let files = HistogramFiles::new(&self.files, self.bin_ps, &self.scenario, &self.set)?;
        let acquisition = acquisition(&files.setup, &files.bins);
        let (mut names, mut histograms) = (Vec::new(), Vec::new());
        for (file, number, histogram) in files.read(&acquisition)? {
            names.push((file, number));
            histograms.push(histogram);
        }
        let name = |number: usize| names[number].clone();
        let found = GlassCalibration::new(&acquisition, &histograms, name)?;
        self.deliver(found, &files.setup, acquisition.shots, console)
    }

    fn deliver(
        &self,
        calibration: GlassCalibration,
        setup: &Setup,
        shots: u64,
        console: &Console,
    ) -> Result<()> {
        let notes = notes(&calibration);
        console.print_notes(&notes)?;
        let findings = GlassFindings { calibration, shots };
        self.result.deliver(&Report::new(findings, setup, &notes, console), console)
    }
}

/// The acquisition without a template, which is being made.
fn acquisition<'a>(setup: &'a Setup, bins: &'a tofsim::optics::Bins) -> Acquisition<'a> {
    let shots = setup.params.frame_ctrl.shots_per_frame.into();
    Acquisition { glass: None, ..Acquisition::of(setup, bins, shots) }
}

/// The scenario with nothing in front of the window that reflects.
fn without_target(mut loaded: Loaded) -> Result<Setup> {
    let scenario = &mut loaded.scenario;
    scenario.estimator.glass_file = None;
    (scenario.target.reflectance, scenario.target.retro_cd_lx_m2) = (0.0, 0.0);
    if scenario.firmware.dark_frames {
        let expected = "expected false: a calibration's histograms all have the laser's light";
        let fault = Input::new(format!("scenario {}", loaded.name), expected);
        return Err(fault.field("firmware.dark_frames").value(true).into());
    }
    Setup::of_counts(loaded)
}

/// Histograms of so many frames, drawn where their shots are independent, else stepped.
fn simulated(setup: &Setup, frames: u64) -> Result<Vec<Histogram>> {
    if let Ok(drawn) = Histograms::new(setup) {
        return Ok((0..frames).map(|index| drawn.frame(index).histogram).collect());
    }
    let frames = Run::new(setup).frames(frames)?;
    Ok(frames.into_iter().map(|frame| frame.histogram).collect())
}

/// Returns the notes on a template that is not known well, and on a window that changed meanwhile.
fn notes(found: &GlassCalibration) -> Vec<Note> {
    let relative_se = found.relative_se();
    let coarse = (relative_se > COARSE).then(|| {
        let text = "the cover window's light is known poorly: take more histograms";
        let expected = format!("{COARSE} at most");
        Note::new(NoteCode::FewHits, "relative_se", relative_se, expected, text)
    });
    let changed =
        found.change.filter(|[change, se]| change.abs() > CHANGED && change.abs() > 5.0 * se);
    let changed = changed.map(|[change, se]| {
        let text = format!(
            "the cover window's light changed by {:+.1} +- {:.1} % over the histograms: the template is their mean; wait \
             until laser and window are warm",
            100.0 * change,
            100.0 * se
        );
        Note::new(NoteCode::PedestalMoved, "change", change, "about 0", text)
    });
    coarse.into_iter().chain(changed).collect()
}
