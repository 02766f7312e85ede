//! Options of verbs that draw histograms.

use std::path::{Component, Path};
use std::thread::available_parallelism;

use rayon::ThreadPoolBuilder;

use tofsim::error::{Error, Input, Result};
use tofsim::scenario::builtin::Source;
use tofsim::scenario::{self, Loaded};
use tofsim_learn::dataset::grid::MOST_ROWS;
use tofsim_learn::dataset::{Grid, Rows, Subset};

use crate::choice::{seed, threads};

use super::host::host;
use super::terminal::Console;

/// Most threads for a core.
const MOST_PER_CORE: usize = 4;

/// Which histograms.
#[derive(Clone, Debug, clap::Args)]
pub struct Draws {
    /// Set a scenario key, e.g. `firmware.shots_per_frame=15000`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Carry chain: uniform, table6_3, ideal (bins of 25 ps), kintex7, or the path of a chain file, from here
    /// [default: the scenario's]
    #[arg(long, value_name = "P")]
    profile: Option<String>,
    /// Draw N random scenes, the same number at each distance, instead of all
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_ROWS))]
    rows: Option<u64>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
}

impl Draws {
    /// A scenario by name or path, with keys set, and with what the other options say.
    pub fn load(&self, scenario: &str, set: &[String]) -> Result<Loaded> {
        let mut loaded = load(scenario, set, self.seed)?;
        if let Some(profile) = &self.profile {
            loaded.scenario.tdc.profile = from_here(profile, &loaded)?;
        }
        Ok(loaded)
    }

    /// A scenario with keys set, and with a network in place of its own, if one is given by name or path.
    pub fn load_with(
        &self,
        scenario: &str,
        network: Option<&str>,
        set: &[String],
    ) -> Result<Loaded> {
        let mut loaded = self.load(scenario, set)?;
        if let Some(network) = network {
            loaded.scenario.estimator.network = from_here(network, &loaded)?;
        }
        Ok(loaded)
    }

    /// Rows of a grid with so many of each scene: as many random ones as the options say, or else
    /// `default`, or all.
    ///
    /// # Errors
    /// When all are too many.
    pub fn rows(&self, default: Option<u64>, grid: &Grid, seed: u64) -> Result<Rows> {
        Ok(match self.rows.or(default) {
            None => Rows::All(grid.clone().repeated(grid.repeats)?),
            Some(rows) => Rows::Subset(Subset::new(grid.clone(), rows, seed)),
        })
    }

    /// Does `work` for so many rows on as many threads as the options say, with a progress bar that it
    /// tells of rows done.
    pub fn on_threads<T: Send>(
        &self,
        rows: u64,
        console: &Console,
        work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> Result<T> + Send,
    ) -> Result<T> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(self.threads.map_or(0, |threads| useful(threads.into())));
        let pool = pool.build().map_err(|error| Input::new("--threads", error))?;
        let progress = console.progress(rows, "rows");
        let done = pool.install(|| work(&|rows| progress.inc(rows)));
        progress.finish_and_clear();
        done
    }
}

/// A scenario by name or path, with keys set, and with a seed instead of its own if there is one.
pub fn load(scenario: &str, set: &[String], seed: Option<u64>) -> Result<Loaded> {
    let mut loaded = scenario::load(scenario, set)?;
    loaded.scenario.seed = seed.unwrap_or(loaded.scenario.seed);
    Ok(loaded)
}

/// Returns the number of threads to make where so many are asked for: the results are the same for any number, and
/// those beyond a few for each core only take memory, and hold each other up.
pub fn useful(threads: usize) -> usize {
    let cores = available_parallelism().map_or(1, usize::from);
    threads.min(MOST_PER_CORE * cores)
}

/// Makes the pool of so many threads, if a number is asked for; within another program, that makes it.
pub fn use_threads(threads: Option<u16>) -> Result<()> {
    let Some(threads) = threads.filter(|_| host().is_none()) else { return Ok(()) };
    let pool = ThreadPoolBuilder::new().num_threads(useful(threads.into())).build_global();
    pool.map_err(|error| Input::new("--threads", error).value(threads).into())
}

/// Converts a path from the current folder to one from the scenario's folder, as the scenario has them; a name stays as
/// it is. The path is relative if it can be, so that results do not depend on where both folders are.
pub fn from_here(name: &str, loaded: &Loaded) -> Result<String> {
    let Source::Folder(folder) = &loaded.files else { return Ok(name.to_owned()) };
    if !name.contains(['/', '.']) {
        return Ok(name.to_owned());
    }
    let is_below = |part: &Component| matches!(part, Component::Normal(_));
    if folder.components().all(|part| is_below(&part)) {
        let relative = "../".repeat(folder.components().count()) + name;
        // A folder that is a link has another one above it.
        let found = folder.join(&relative).canonicalize().ok();
        if found == Path::new(name).canonicalize().ok() {
            return Ok(relative);
        }
    }
    let path = std::path::absolute(name).map_err(Error::io(Path::new(name), "read"))?;
    Ok(path.display().to_string())
}
