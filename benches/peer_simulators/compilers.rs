//! Compilation of all peers, two at a time.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;

use crate::builds::Cache;
use crate::contender::Contender;
use crate::{Result, icarus, verilator, versions};

/// Variant of the Verilog sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sources {
    /// The sources in `rtl_ref`.
    Reference,
    /// The sources in `rtl_ref`, with the fastest coding of the decoder's ones count.
    FastDecoder,
}

impl Sources {
    /// Returns the files.
    pub fn files(self, root: &Path) -> Result<Vec<PathBuf>> {
        let ours = root.join("benches/peer_simulators/rtl");
        let mut files = Vec::new();
        for entry in fs::read_dir(root.join("rtl_ref"))? {
            let file = entry?.path();
            let Some(block) = file.file_stem().and_then(|stem| stem.to_str()) else { continue };
            if file.extension().is_none_or(|ending| ending != "v") || block == "kc705_top" {
                continue;
            }
            let is_replaced = match block {
                // It is never started, and nobody is to pay for that.
                "centroid_estimator" => true,
                "tdc_decoder" => self == Sources::FastDecoder,
                _ => false,
            };
            files.push(if is_replaced { ours.join(format!("{block}.sv")) } else { file });
        }
        files.sort();
        Ok(files)
    }
}

/// Formats an absolute path for the tools.
pub fn absolute(path: &Path) -> String {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf()).display().to_string()
}

type Job<'a> = Box<dyn FnOnce() -> Result<Vec<Contender>> + Send + 'a>;

/// Builds the peers. Verilator is required; any other missing tool becomes a note.
pub fn peers(root: &Path, cache: &Cache, quick: bool) -> Result<(Vec<Contender>, Vec<String>)> {
    if versions::first_line("verilator", "--version").is_none() {
        return Err("verilator is missing: apt-get install verilator".into());
    }
    let mut jobs: Vec<(&str, Job)> = Vec::new();
    for variant in &verilator::VARIANTS {
        let job = move || Ok(vec![variant.contender(root, cache)?]);
        jobs.push(("verilator", Box::new(job)));
    }
    jobs.push(("icarus", Box::new(|| Ok(vec![icarus::contender(root, cache, quick)?]))));
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
