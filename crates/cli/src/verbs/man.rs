//! `tofsim man`: manual pages.

use std::path::{Path, PathBuf};

use clap::Command;
use clap_mangen::Man;

use tofsim::error::{Error, Result};
use tofsim::files::output::{create_directory, write_bytes};

use super::terminal::{Console, print};

/// Print the manual page, or write one for each subcommand
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Write tofsim.1, tofsim-run.1 and so on into this folder instead
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Prints or writes the pages of `command`.
pub fn run(args: &Args, mut command: Command, console: &Console) -> Result<()> {
    command.build();
    let Some(folder) = &args.output else {
        return print(&String::from_utf8_lossy(&page(command)?));
    };
    create_directory(folder)?;
    pages(&command, "tofsim".to_owned(), folder, console)
}

fn pages(command: &Command, name: String, folder: &Path, console: &Console) -> Result<()> {
    let text = page(command.clone())?;
    let path = folder.join(format!("{name}.1"));
    write_bytes(&path, text)?;
    console.wrote(&path);
    let mut below = command.get_subcommands();
    below.try_for_each(|sub| pages(sub, format!("{name}-{}", sub.get_name()), folder, console))
}

fn page(command: Command) -> Result<Vec<u8>> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text).map_err(Error::io(Path::new("manual page"), "write"))?;
    Ok(text)
}
