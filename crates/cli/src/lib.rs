//! The command `tofsim`, for the program of that name and for the Python package, which has it too.

// Messages go through `tell`, which a closed pipe does not end.
#![deny(clippy::print_stderr)]

#[doc(hidden)]
pub mod choice;
mod page;
#[doc(hidden)]
pub mod record;
#[doc(hidden)]
pub mod report;
mod reproduce;
mod text;
#[doc(hidden)]
pub mod verbs;

use std::ffi::OsString;
use std::process::ExitCode;

use verbs::{Cli, interrupt};

use tofsim::error::Error;

use text::wrap::message;

/// Differences found, or a check failed.
const DIFFERENT: u8 = 1;
/// Usage or input error.
const FAULT: u8 = 2;

/// Does what a command line asks for, whose first word is the program's name; its exit status. A fault
/// in the command line itself ends the process.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = Cli::read(words);
    interrupt::listen();
    match cli.run() {
        Ok(ExitCode::SUCCESS) => 0,
        Ok(_) => DIFFERENT,
        Err(error) if error.is_broken_pipe() => 0,
        Err(Error::Interrupted) => {
            interrupt::say();
            interrupt::INTERRUPTED
        }
        Err(error) => {
            message(format_args!("tofsim: {error}"));
            FAULT
        }
    }
}
