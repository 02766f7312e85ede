//! `tofsim serve`: the acquisition computer as a page, by the program `tofsim-serve`.
//!
//! The server is a program of its own, so that nobody who wants a depth compiles one.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use tofsim::error::{Error, Input, Result, tell};
use tofsim::note::Note;
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::choice::seed;

use super::host::host;
use super::options::ScenarioArgs;
use super::rerun;
use super::terminal::Console;

/// Program that serves the page; it lies beside this one.
const PROGRAM: &str = "tofsim-serve";

/// Serve the acquisition computer as a web page on this computer, for a simulated run or a board
///
/// The page shows control signals, which act on the running model; the histogram by cause; the depths and their
/// bound; the scene; a logic analyser; and the waveform of a shot. Of an array, it shows the depth image. The command prints its URL, which contains a
/// secret, and runs until Ctrl-C.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim serve\n  \
    tofsim serve far -s target.reflectance=0.6 --fidelity shot --port 8080\n  \
    tofsim serve array              depth images, one after the other\n  \
    tofsim serve -s tdc.recalibrate_frames=64 --board /dev/ttyUSB0")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Simulation fidelity; cycle and shot give identical frames [default: cycle, and histogram for an array]
    #[arg(long, value_enum)]
    fidelity: Option<Way>,
    /// Port on 127.0.0.1; 0 selects a free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Serial port of a board, e.g. /dev/ttyUSB0: show its frames instead of simulated ones
    #[arg(long, value_name = "PORT")]
    board: Option<String>,
    /// Baud rate of the board, the firmware's parameter Baud
    #[arg(long, value_name = "N", requires = "board", value_parser = clap::value_parser!(u32).range(300..=20_000_000))]
    baud: Option<u32>,
    /// Longest wait for the board's answer [s]; a simulated board needs more
    #[arg(long, value_name = "S", requires = "board", value_parser = clap::value_parser!(u64).range(1..=86_400))]
    timeout: Option<u64>,
    /// Accept a board that was built with other parameters than those of the scenario
    #[arg(long, requires = "board")]
    any_parameters: bool,
    /// Largest number of frames, or of images, per second
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rate: u32,
    /// Wait for Start to be pressed before the first frame
    #[arg(long)]
    stopped: bool,
    /// Print one JSON object instead of the address
    #[arg(long)]
    json: bool,
}

/// Simulation fidelities of the page.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Way {
    /// Every cycle, with the cause of every avalanche
    Cycle,
    /// Skips idle cycles; causes are expected values
    Shot,
    /// Draws each frame's histogram; for arrays only
    Histogram,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    if rerun::PROGRAM.get().is_some() || host().is_some() {
        let expected = "is not in the Python package, which has no server: install the command with \
            `cargo install --path crates/cli` and `cargo install --path crates/serve`";
        return Err(Input::new("serve", expected).into());
    }
    console.print_notes(&args.notes(args.scenario.load(args.seed)?)?)?;
    let program = program()?;
    if !program.is_file() {
        tell(format_args!("tofsim: {} is missing: {}", program.display(), advice(&program)));
        return Ok(ExitCode::FAILURE);
    }
    become_program(Command::new(&program).args(args.words(console)))
        .map_err(Error::io(&program, "run"))
}

impl Args {
    /// Checks the scenario, and returns the notes on its results.
    fn notes(&self, loaded: Loaded) -> Result<Vec<Note>> {
        if self.board.is_some() || loaded.scenario.array.count() == 1 {
            return Setup::new(loaded)?.notes();
        }
        let array = ArraySetup::new(loaded)?;
        Ok([array.notes()?, notes_of_firmware(array.common())].concat())
    }

    /// Returns the options of the program.
    fn words(&self, console: &Console) -> Vec<String> {
        let fidelity = self.fidelity.map(|fidelity| match fidelity {
            Way::Cycle => "cycle",
            Way::Shot => "shot",
            Way::Histogram => "histogram",
        });
        let mut words: Vec<_> = fidelity.iter().map(|word| format!("--fidelity={word}")).collect();
        words.extend([format!("--port={}", self.port), format!("--rate={}", self.rate)]);
        words.extend(self.scenario.set.iter().map(|set| format!("--set={set}")));
        words.extend(self.seed.map(|seed| format!("--seed={seed}")));
        words.extend(self.board.iter().map(|port| format!("--board={port}")));
        words.extend(self.baud.map(|baud| format!("--baud={baud}")));
        words.extend(self.timeout.map(|seconds| format!("--timeout={seconds}")));
        // Notes have been said.
        words.push("--without-notes".to_owned());
        let flags = [
            ("--any-parameters", self.any_parameters),
            ("--stopped", self.stopped),
            ("--json", self.json),
            ("--quiet", console.is_quiet()),
        ];
        words
            .extend(flags.iter().filter(|(_, is_set)| *is_set).map(|(flag, _)| (*flag).to_owned()));
        words.extend(["--".to_owned(), self.scenario.scenario.clone()]);
        words
    }
}

/// The program beside this one.
fn program() -> Result<PathBuf> {
    let own = std::env::current_exe().map_err(Error::io(PROGRAM.as_ref(), "find"))?;
    Ok(own.with_file_name(format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX)))
}

/// Returns how to get the program where it is missing, in the repository.
fn advice(program: &Path) -> String {
    let folder = program.parent().unwrap_or(Path::new(""));
    let is = |folder: &Path, name: &str| folder.file_name().is_some_and(|own| own == name);
    let build = format!("build it with `cargo build --release -p {PROGRAM}`");
    match folder.parent() {
        Some(root) if is(folder, "bin") => {
            let root = root.display();
            format!("install it with `cargo install --path crates/serve --root {root}`")
        }
        Some(_) if folder.ancestors().any(|above| is(above, "target")) => {
            if is(folder, "debug") {
                build.replace(" --release", "")
            } else {
                build
            }
        }
        _ => format!("{build} and copy it there"),
    }
}

/// Goes on as another program, which has the terminal and its signals.
#[cfg(unix)]
fn become_program(command: &mut Command) -> std::io::Result<ExitCode> {
    use std::os::unix::process::CommandExt;
    Err(command.exec())
}

/// Runs another program to its end.
#[cfg(not(unix))]
fn become_program(command: &mut Command) -> std::io::Result<ExitCode> {
    let status = command.status()?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_leads_to_a_program_beside_this_one() {
        let advice = |program: &str| advice(Path::new(program));
        let build = "build it with `cargo build --release -p tofsim-serve`";
        assert_eq!(advice("/home/me/tofsim/target/release/tofsim-serve"), build);
        let debug = "build it with `cargo build -p tofsim-serve`";
        assert_eq!(advice("target/debug/tofsim-serve"), debug);
        let install = "install it with `cargo install --path crates/serve --root /home/me/.cargo`";
        assert_eq!(advice("/home/me/.cargo/bin/tofsim-serve"), install);
        assert_eq!(advice("/opt/tofsim/tofsim-serve"), format!("{build} and copy it there"));
    }
}
