//! Benchmark of tofsim, Verilator and Icarus on the same frames: `benches/peers` (`--help`).
//!
//! It builds the peers, checks that all produce tofsim's depth, shots and cycles, and times them in turn on one core.
//! tofsim draws its photons on the fly; the peers have them in memory.

mod builds;
mod compilers;
mod contender;
mod expected;
mod icarus;
mod ours;
mod pinning;
mod report;
mod rounds;
mod run;
mod sources;
mod verilator;
mod versions;

use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use builds::Cache;
use clap::Parser;
use compilers::Workshop;
use contender::{Contender, Context, FEW_SHOTS, SHOTS};
use expected::Expected;
use report::Report;
use rounds::Plan;

/// Any error.
type Fault = Box<dyn std::error::Error + Send + Sync>;
/// Shorthand.
type Result<T> = std::result::Result<T, Fault>;

/// Laser rates, fastest and slowest.
const LASER_FREQS: [u8; 2] = [3, 0];

/// Time tofsim and other simulators on the same frames
#[derive(Debug, Parser)]
#[command(name = "peers", bin_name = "benches/peers")]
pub struct Args {
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Finish within two minutes: fewer repetitions, and Icarus with frames of 300 shots
    #[arg(long)]
    quick: bool,
    /// Only compare a frame of 300 shots of each simulator, in half a minute
    #[arg(long, conflicts_with_all = ["json", "quick", "core"])]
    check: bool,
    /// Core to run on [default: the last one]
    #[arg(long, value_name = "N")]
    core: Option<usize>,
    /// Flag that cargo passes to benchmarks
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    match compare(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("peers: {fault}");
            ExitCode::FAILURE
        }
    }
}

fn compare(args: &Args) -> Result<()> {
    let begun = Instant::now();
    let root = &Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).canonicalize()?;
    let cache = Cache::new(Path::new(env!("CARGO_TARGET_TMPDIR")))?;
    let folder = scratch()?;
    let contexts = LASER_FREQS.map(|laser_freq| Context::new(root, folder.path(), laser_freq));
    let contexts = contexts.into_iter().collect::<Result<Vec<_>>>()?;
    let workshop = Workshop {
        root,
        cache: &cache,
        shots: if args.check { FEW_SHOTS } else { SHOTS },
        is_timed: !args.check,
        training: &contexts[0],
    };
    let (peers, notes) = compilers::peers(&workshop, args.quick)?;
    contexts.iter().try_for_each(|context| check(&peers, context))?;
    if args.check {
        println!("{} simulators give tofsim's frames", peers.len());
        return notes.first().map_or(Ok(()), |missing| Err(missing.as_str().into()));
    }
    let mut report = Report::new(notes, pinning::pin(args.core)?);
    for (done, context) in contexts.iter().enumerate() {
        let left = contexts.len() - done;
        report.add(context.laser_freq, &rounds::run(&peers, context, &plan(args, begun, left))?);
    }
    report.print(args.json)
}

/// Creates a folder for photons and waveforms, in memory if possible.
fn scratch() -> Result<tempfile::TempDir> {
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
    Ok(folder?)
}

/// Checks that every peer produces tofsim's frames.
///
/// # Errors
/// The names of the peers that do not.
fn check(peers: &[Contender], context: &Context) -> Result<()> {
    let mut differing = Vec::new();
    for peer in peers.iter().filter(|peer| !peer.is_slow) {
        let (work, laser_freq) = (peer.work.name(), context.laser_freq);
        eprintln!("peers: checking {} ({work}) at laser_freq {laser_freq}", peer.simulator);
        let frames = peer.run(context, 2)?.frames;
        if let Err(difference) = context.expected(peer.shots).check(&frames) {
            differing.push(format!("{peer} differs from tofsim: {difference}"));
        }
    }
    if differing.is_empty() { Ok(()) } else { Err(differing.join("\n").into()) }
}

fn plan(args: &Args, begun: Instant, left: usize) -> Plan {
    if !args.quick {
        return Plan { rounds: 21, slow_rounds: 3, until: None };
    }
    let share = Duration::from_secs(75).saturating_sub(begun.elapsed()) / left as u32;
    Plan { rounds: 7, slow_rounds: 1, until: Some(Instant::now() + share) }
}
