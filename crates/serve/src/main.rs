//! The program `tofsim-serve`, which `tofsim serve` runs.
#![deny(clippy::print_stderr)]

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use serde_json::json;
use tokio::signal::unix::{SignalKind, signal};

use tofsim::error::{Error, Input, Result, tell};
use tofsim_serve::Options;
use tofsim_serve::engine::Engine;
use tofsim_serve::http::Server;
use tofsim_serve::served::Served;

/// Exit status for a usage or input error.
const FAULT: u8 = 2;
/// Exit status for an interruption by Ctrl-C or a signal.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    let options = Options::parse();
    match serve(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(Error::Interrupted) => ExitCode::from(INTERRUPTED),
        Err(error) => {
            tell(format_args!("tofsim-serve: {error}"));
            ExitCode::from(FAULT)
        }
    }
}

fn serve(options: &Options) -> Result<()> {
    let served = Served::of(options)?;
    if !options.quiet && !options.without_notes {
        served.notes()?.iter().for_each(tell);
    }
    let (engine, thread) = Engine::start(options.clone())?;
    let threads = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let threads = threads.map_err(|error| Input::new("server", error))?;
    let ended = threads.block_on(async {
        let stop = |kind| signal(kind).map_err(|error| Input::new("signals", error));
        let mut interrupt = stop(SignalKind::interrupt())?;
        let mut terminate = stop(SignalKind::terminate())?;
        let server = Server::bind(engine, options.port).await?;
        say(options, &served, &server.url())?;
        tokio::select! {
            never = server.run() => never,
            _ = interrupt.recv() => Err(Error::Interrupted),
            _ = terminate.recv() => Err(Error::Interrupted),
        }
    });
    // What holds the engine goes first; then a board is left with the laser off.
    drop(threads);
    thread.join().map_err(|_| Input::new("simulation", "the thread has panicked"))?;
    ended
}

/// Prints the page's URL.
fn say(options: &Options, served: &Served, url: &str) -> Result<()> {
    let setup = served.setup();
    let line = if options.json {
        json!({
            "schema": "tofsim.serve/1",
            "url": url,
            "scenario": setup.name,
            "seed": setup.scenario.seed,
            "fidelity": served.fidelity.name(),
            "set": setup.set,
            "hash": setup.hash(),
            "notes": served.notes()?,
        })
        .to_string()
    } else {
        url.to_owned()
    };
    let mut out = io::stdout().lock();
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))?;
    if !options.quiet && !options.json {
        tell("open this address in a browser on this computer; Ctrl-C ends it");
    }
    Ok(())
}
