//! The command `tofsim`.

mod choice;
mod record;
mod report;
mod text;
mod verbs;

use std::process::ExitCode;

use verbs::Cli;

use tofsim::error::Error;

/// Interrupted by the user, as shells have it.
const INTERRUPTED: u8 = 130;
/// Usage or input error.
const FAULT: u8 = 2;

fn main() -> ExitCode {
    match Cli::given().run() {
        Ok(status) => status,
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(Error::Interrupted) => {
            eprintln!("tofsim: interrupted");
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            eprintln!("tofsim: {error}");
            ExitCode::from(FAULT)
        }
    }
}
