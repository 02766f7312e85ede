//! Compilation of all peers, two at a time.

use std::path::Path;
use std::sync::Mutex;
use std::thread;

use crate::builds::Cache;
use crate::contender::{Contender, Context};
use crate::{Result, icarus, verilator, versions};

/// Where and for what the peers are built.
#[derive(Clone, Copy)]
pub struct Workshop<'a> {
    /// Folder of the repository.
    pub root: &'a Path,
    /// Peers that were built before.
    pub cache: &'a Cache,
    /// Number of shots of a frame.
    pub shots: u64,
    /// True if the peers are timed, so that the fastest options are worth their compilation.
    pub is_timed: bool,
    /// The frame that compilers learn from.
    pub training: &'a Context,
}

type Job<'a> = Box<dyn FnOnce() -> Result<Vec<Contender>> + Send + 'a>;

/// Builds the peers. Verilator is required; any other missing tool becomes a note.
pub fn peers(workshop: &Workshop, quick: bool) -> Result<(Vec<Contender>, Vec<String>)> {
    if versions::first_line("verilator", "--version").is_none() {
        return Err("verilator is missing: apt-get install verilator".into());
    }
    let mut jobs: Vec<(&str, Job)> = Vec::new();
    for variant in &verilator::VARIANTS {
        let job = move || Ok(vec![variant.contender(workshop)?]);
        jobs.push(("verilator", Box::new(job)));
    }
    jobs.push(("icarus", Box::new(|| Ok(vec![icarus::contender(workshop, quick)?]))));
    sort_out(side_by_side(jobs))
}

type Built<'a> = (&'a str, Result<Vec<Contender>>);

/// Runs jobs in two threads, and returns their results in order.
fn side_by_side<'a>(jobs: Vec<(&'a str, Job<'a>)>) -> Vec<Built<'a>> {
    let queue = Mutex::new(jobs.into_iter().enumerate());
    let done = Mutex::new(Vec::new());
    let work = || {
        loop {
            let Some((index, (name, job))) = queue.lock().ok().and_then(|mut jobs| jobs.next())
            else {
                return;
            };
            let built = job();
            if let Ok(mut done) = done.lock() {
                done.push((index, (name, built)));
            }
        }
    };
    thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let mut done = done.into_inner().unwrap_or_default();
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, built)| built).collect()
}

fn sort_out(built: Vec<Built>) -> Result<(Vec<Contender>, Vec<String>)> {
    let (mut peers, mut notes) = (Vec::new(), Vec::new());
    for (name, result) in built {
        match result {
            Ok(some) => peers.extend(some),
            Err(fault) if name == "verilator" => return Err(fault),
            Err(fault) => {
                eprintln!("peers: {name} is left out: {fault}");
                notes.push(format!("{name} is left out: {fault}"));
            }
        }
    }
    Ok((peers, notes))
}
