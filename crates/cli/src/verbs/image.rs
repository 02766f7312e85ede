//! `tofsim image`: depth images of an array of pixels.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::note::merged;
use tofsim::sim::image::{Pixel, simulate};
use tofsim::sim::setup::array::ArraySetup;
use tofsim::sim::shot_recorder::Shot;
use tofsim_learn::dataset::shot_file::ShotFile;
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::choice::{self, Fidelity, WaveformChoice, seed, threads, words};
use crate::record::Record;
use crate::report::image::{DepthImages, ImagePixel};
use crate::report::link_budget::LinkBudget;
use crate::report::run_files::is_same;
use crate::report::writer::Report;

use super::draws::{load, use_threads};
use super::frames;
use super::options::ResultArgs;
use super::pixel::PixelPlace;
use super::terminal::{Console, stop_signal};
use super::wave_plan::{SignalArgs, WavePlan};

/// Simulate depth images of an array of pixels
///
/// Each pixel is simulated as an instrument of its own, with the light from its part of the scene. In docs/image.md are the
/// formats of the files, and what pixels do not share yet.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim image -o out             40 x 30 pixels\n  \
    tofsim image -s array.rows=8 -s array.columns=6 --images 100\n  \
    tofsim image --pixel 20,15      one pixel of them, the same frames\n  \
    tofsim image -s array.rows=8 -s array.columns=6 --events shots.parquet\n  \
    tofsim image --waves fst --window shot:0..8 --signals 'channel_7.*'\n  \
    tofsim image mine.toml --fidelity histogram -o out")]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = "array")]
    scenario: String,
    /// Set a scenario key, e.g. `array.rows=8`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Number of images
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    images: u64,
    /// Simulation fidelity: cycle and shot give identical images, histogram images of the same distribution
    #[arg(long, value_parser = words(&Fidelity::ALL), default_value = "shot")]
    fidelity: Fidelity,
    /// Write the waveform of the firmware that scans the array
    #[arg(long, value_parser = words(choice::WAVEFORM), default_value = "none")]
    waves: WaveformChoice,
    #[command(flatten)]
    shown: SignalArgs,
    /// Simulate this pixel alone: its row from the top and its column from the left, from 0
    #[arg(long, value_name = "ROW,COL")]
    pixel: Option<PixelPlace>,
    /// Write a row per shot of every pixel, as .csv or .parquet; one thread simulates them, pixel by pixel
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let array = ArraySetup::new(load(&args.scenario, &args.set, args.seed)?)?;
    let setup = array.common();
    frames::check("--images", args.images, setup)?;
    let place = args.pixel.map(|pixel| pixel.within(&array)).transpose()?;
    use_threads(args.threads)?;

    let stop = stop_signal();
    let mut events = args.events(&array, console)?;
    let waves = args.trace(&array, stop.as_deref(), console)?;
    let [rows, columns] = place.map_or(array.size(), |_| [1, 1]);
    let progress = console.progress(args.images * (rows * columns) as u64, "frames");
    let done = |frames| progress.inc(frames);
    let simulated = args.simulate((&array, place), events.as_mut(), stop.as_deref(), &done)?;
    progress.finish_and_clear();
    let written = events.map(ShotFile::finish).transpose()?;

    let mut notes = merged(simulated.iter().map(|pixel| &pixel.notes[..]));
    notes.extend(notes_of_firmware(setup));
    notes.extend(LinkBudget::of(setup.clone()).eye_safety_notes());
    console.print_notes(&notes)?;
    let pixels = match place {
        None => ImagePixel::all(&array, simulated),
        Some(place) => {
            simulated.into_iter().map(|pixel| ImagePixel::new(&array, place, pixel)).collect()
        }
    };
    let (fidelity, images) = (args.fidelity.name(), args.images);
    let images = DepthImages { array: &array, fidelity, images, waves, pixels };
    args.result.deliver(&Report::new(images, setup, &notes, console), console)?;
    written.iter().for_each(|path| console.wrote(path));
    Ok(())
}

impl Args {
    /// Begins the file of events, if it is wanted.
    fn events(&self, array: &ArraySetup, console: &Console) -> Result<Option<ShotFile>> {
        let Some(path) = &self.events else { return Ok(None) };
        let fault = |expected| Err(Input::new("--events", expected).value(path.display()).into());
        if self.fidelity == Fidelity::Histogram {
            return fault(
                "--fidelity histogram has no single shots: expected --fidelity shot or cycle",
            );
        }
        let own = self.result.output.as_ref().map(|folder| folder.join("pixels.csv"));
        if own.is_some_and(|own| is_same(&own, path)) {
            return fault("expected another name: the images have a file of their own there");
        }
        let record = Record::new(array.common(), &console.command);
        Ok(Some(ShotFile::of_images(path, &record.line())?))
    }

    /// Simulates the pixels on all threads, or one after the other where their shots are written.
    fn simulate(
        &self,
        (array, place): (&ArraySetup, Option<[usize; 2]>),
        mut events: Option<&mut ShotFile>,
        stop: Option<&AtomicBool>,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<Pixel>> {
        let (fidelity, [rows, columns]) = (self.fidelity.of_images(), array.size());
        let places = match place {
            Some(place) => vec![place],
            None if events.is_none() => return array.images(fidelity, self.images, stop, done),
            None => (0..rows * columns).map(|place| [place / columns, place % columns]).collect(),
        };
        let pixel = |place: [usize; 2]| {
            let setup = array.pixel(place[0], place[1]);
            let pixel = match &mut events {
                None => simulate(&setup, fidelity, self.images, None, stop)?,
                Some(events) => {
                    let mut write = |shot: &Shot| events.write(place, shot);
                    simulate(&setup, fidelity, self.images, Some(&mut write), stop)?
                }
            };
            done(self.images);
            Ok(pixel)
        };
        places.into_iter().map(pixel).collect()
    }

    /// Writes the waveform of the firmware, if it is wanted, and returns its path.
    fn trace(
        &self,
        array: &ArraySetup,
        stop: Option<&AtomicBool>,
        console: &Console,
    ) -> Result<Option<String>> {
        let Some(format) = self.waves else {
            return match self.shown.given().iter().find(|(_, given)| *given) {
                Some((option, _)) => Err(Input::new(*option, "expected --waves vcd or fst").into()),
                None => Ok(None),
            };
        };
        if self.pixel.is_some() {
            let expected =
                "expected none with --pixel: the waveform of a pixel is that of `run --pixel`";
            return Err(Input::new("--waves", expected).into());
        }
        let setup = array.with_firmware()?;
        let windows = array.windows(&self.shown.window, self.images)?;
        let folder = (self.result.output.as_deref(), format);
        let plan = WavePlan::new(folder, &setup, &self.shown.signals, windows)?;
        let _held = plan.path.parent().map(FolderLock::take).transpose()?;
        let record = Record::new(&setup, &console.command);
        let marks = array.trace(plan.open(&record, &setup)?, self.images, stop)?;
        plan.finish(&marks)?;
        Ok(Some(plan.path.display().to_string()))
    }
}
