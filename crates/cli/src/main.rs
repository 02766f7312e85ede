//! The command `tofsim`.

mod choice;
mod page;
mod record;
mod report;
mod reproduce;
mod text;
mod verbs;

use std::process::ExitCode;

use verbs::{Cli, interrupt};

use tofsim::error::Error;

/// Usage or input error.
const FAULT: u8 = 2;

fn main() -> ExitCode {
    let cli = Cli::read();
    interrupt::listen();
    match cli.run() {
        Ok(status) => status,
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(Error::Interrupted) => {
            interrupt::say();
            ExitCode::from(interrupt::INTERRUPTED)
        }
        Err(error) => {
            eprintln!("tofsim: {error}");
            ExitCode::from(FAULT)
        }
    }
}
