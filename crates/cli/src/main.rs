//! The command `tofsim`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(tofsim_cli::run(std::env::args_os()))
}
