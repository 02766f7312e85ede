//! `tofsim board watch`: a line for each frame, until it is interrupted.

use tofsim::error::Result;
use tofsim::sim::estimates::Estimate;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_board::{LaserState, check_frames};

use crate::text::table::{fixed, grouped};
use crate::verbs::options::ScenarioArgs;
use crate::verbs::terminal::{Console, print, stop_signal};

use super::connection::{LaserArgs, ParametersArgs, PortArgs};

/// Print a line for each frame of a board until Ctrl-C: depth, sigma, hits, status, laser faults
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  tofsim board watch --laser --port /dev/ttyUSB0")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    port: PortArgs,
    #[command(flatten)]
    parameters: ParametersArgs,
    #[command(flatten)]
    laser: LaserArgs,
}

/// Runs the verb, which ends when it is interrupted or the board does not answer.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let setup = Setup::new(args.scenario.load(None)?)?;
    check_frames(&setup)?;
    let mut board = args.port.open(&setup, args.parameters)?;
    console.print_notes(&args.laser.note().into_iter().collect::<Vec<_>>())?;
    let stop = stop_signal();
    print(&line(["frame", "depth [m]", "sigma [mm]", "hits", "status", "laser faults"]))?;
    let mut show = |frame: &Frame, laser: LaserState| print(&row(frame, laser));
    board.take_frames(&setup, args.laser.laser, u64::MAX, stop.as_deref(), &mut show)
}

fn row(frame: &Frame, laser: LaserState) -> String {
    let estimate = frame.estimate();
    let Estimate { sigma_m, .. } = estimate;
    let sigma = sigma_m.map_or("-".to_owned(), |sigma_m| fixed(1e3 * sigma_m, 3));
    let status = estimate.rejection().unwrap_or_else(|| "-".to_owned());
    let (depth, hits) = (fixed(frame.depth_m(), 6), grouped(frame.hits()));
    line([&frame.index.to_string(), &depth, &sigma, &hits, &status, &list(&laser.faults())])
}

/// Returns words in one cell.
fn list(words: &[&str]) -> String {
    if words.is_empty() { "-".to_owned() } else { words.join(", ") }
}

/// Returns cells in columns that do not wait for the widest one.
fn line([frame, depth, sigma, hits, status, faults]: [&str; 6]) -> String {
    format!("{frame:>7}  {depth:>10}  {sigma:>10}  {hits:>9}  {status:<20}  {faults}\n")
}
