//! tofsim's implementation of each kind of work.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use tofsim::hierarchy;
use tofsim::kernel::Time;
use tofsim::scenario::window::Window;
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Run, Stepping};
use tofsim::waves::{WaveFormat, Waves};

use crate::Result;
use crate::contender::Work;

/// Approximate minimum duration of a timing.
const LONG_ENOUGH: Duration = Duration::from_millis(60);
/// Largest number of frames of a timing.
const MOST_FRAMES: u32 = 10_000;

/// Returns the number of frames for a sufficiently long timing.
pub fn frames(work: Work, setup: &Setup, folder: &Path) -> Result<u64> {
    let begun = Instant::now();
    run(work, setup, 1, folder)?;
    let took = begun.elapsed().as_nanos().max(1);
    Ok(LONG_ENOUGH.as_nanos().div_ceil(took).clamp(1, MOST_FRAMES.into()) as u64)
}

/// Times one kind of work [ms per frame].
pub fn time(work: Work, setup: &Setup, frames: u64, folder: &Path) -> Result<f64> {
    let begun = Instant::now();
    run(work, setup, frames, folder)?;
    Ok(begun.elapsed().as_secs_f64() * 1e3 / frames as f64)
}

fn run(work: Work, setup: &Setup, frames: u64, folder: &Path) -> Result<()> {
    match work {
        Work::Cycle => cycle(setup, frames),
        Work::CycleSkip => cycle_skip(setup, frames),
        Work::Shot => shot(setup, frames),
        Work::Histogram => histogram(setup, frames),
        Work::Vcd => waveform(setup, frames, WaveFormat::Vcd, work.waveform(folder).as_deref()),
        Work::Fst => waveform(setup, frames, WaveFormat::Fst, work.waveform(folder).as_deref()),
    }
}

/// Simulates every cycle.
fn cycle(setup: &Setup, frames: u64) -> Result<()> {
    at(Stepping::EveryCycle, setup, frames)
}

/// Skips idle cycles.
fn cycle_skip(setup: &Setup, frames: u64) -> Result<()> {
    at(Stepping::SkipIdle, setup, frames)
}

/// Simulates shot by shot.
fn shot(setup: &Setup, frames: u64) -> Result<()> {
    at(Stepping::LeapShots, setup, frames)
}

fn at(stepping: Stepping, setup: &Setup, frames: u64) -> Result<()> {
    black_box(Run::new(setup).stepping(stepping).observe(frames, Observers::default())?);
    Ok(())
}

/// Draws each frame's histogram at once; the probabilities are computed once for all frames.
fn histogram(setup: &Setup, frames: u64) -> Result<()> {
    let histograms = Histograms::new(setup)?;
    for index in 0..frames {
        black_box(histograms.frame(index));
    }
    Ok(())
}

/// Simulates every cycle, and writes every signal to a waveform.
fn waveform(setup: &Setup, frames: u64, format: WaveFormat, path: Option<&Path>) -> Result<()> {
    let path = path.ok_or("a waveform needs a path")?;
    let (entries, encoder) = (hierarchy::entries(&setup.params), &setup.params.tdc.decoder.encoder);
    let waves = Waves::create(path, format, &entries, encoder, &[])?;
    let to = setup.end(frames).unwrap_or(Time::NEVER);
    let windows = vec![Window::Span { from: Time::ZERO, to }];
    let watch = Observers { waves: Some((waves, windows)), ..Observers::default() };
    black_box(Run::new(setup).observe(frames, watch)?);
    Ok(())
}
