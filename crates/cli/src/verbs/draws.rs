//! Options of verbs that draw histograms.

use std::path::Path;

use rayon::ThreadPoolBuilder;

use tofsim::error::{Error, Input, Result};
use tofsim::scenario::{self, Loaded, builtin};
use tofsim_learn::dataset::grid::MOST_ROWS;
use tofsim_learn::dataset::{Grid, Rows, Subset};

use super::host::host;
use super::terminal::Talk;

/// Threads that may be asked for; each has to be made before it can help.
pub const MOST_THREADS: i64 = 1024;

/// Which histograms.
#[derive(Debug, clap::Args)]
pub struct Draws {
    /// Set a scenario key, e.g. `firmware.shots_per_frame=15000`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Carry chain: uniform, table6_3, ideal (bins of 25 ps), kintex7, or the path of a chain file, from here
    /// [default: the scenario's]
    #[arg(long, value_name = "P")]
    profile: Option<String>,
    /// Draw so many random scenes, equally many at each distance, instead of all
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(1..=MOST_ROWS))]
    rows: Option<u64>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
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
        talk: &Talk,
        work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> Result<T> + Send,
    ) -> Result<T> {
        let pool = ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0).into());
        let pool = pool.build().map_err(|error| Input::new("--threads", error))?;
        let progress = talk.progress(rows, "rows");
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

/// Makes the pool of so many threads, if a number is asked for; within another program, that makes it.
pub fn use_threads(threads: Option<u16>) -> Result<()> {
    let Some(threads) = threads.filter(|_| host().is_none()) else { return Ok(()) };
    let pool = ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
    pool.map_err(|error| Input::new("--threads", error).value(threads).into())
}

/// A name as it is, and a path as the scenario has to have it, which sees paths from its own folder.
pub fn from_here(name: &str, loaded: &Loaded) -> Result<String> {
    if !name.contains(['/', '.']) || loaded.files == builtin::Source::BuiltIn {
        return Ok(name.to_owned());
    }
    let path = std::path::absolute(name).map_err(Error::io(Path::new(name), "read"))?;
    Ok(path.display().to_string())
}
