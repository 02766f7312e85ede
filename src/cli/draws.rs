//! Options of verbs that draw histograms of the thesis's test grid.

use rayon::ThreadPool;

use crate::dataset::{Grid, Rows, Subset};
use crate::error::{Input, Result};
use crate::scenario::{self, Loaded};

use super::dataset::from_here;

/// Which histograms.
#[derive(Debug, clap::Args)]
pub struct Draws {
    /// Built-in scenario, or the path of a scenario file, for all but the scene
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as firmware.shots_per_frame=15000; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Carry chain: uniform, table6_3, ideal (bins of 25 ps), or the path of a chain file, from here
    /// [default: the scenario's]
    #[arg(long, value_name = "P")]
    profile: Option<String>,
    /// Draw so many random scenes, equally many at each distance, instead of all
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(1..1 << 40))]
    rows: Option<u64>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Threads; the figures are the same for any number [default: one a core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl Draws {
    /// The scenario with a network in it, by name or as a path from here.
    pub fn load(&self, network: &str) -> Result<Loaded> {
        let mut loaded = scenario::load(&self.scenario, &self.set)?;
        if let Some(seed) = self.seed {
            loaded.scenario.seed = seed;
        }
        if let Some(profile) = &self.profile {
            loaded.scenario.tdc.profile = from_here(profile)?;
        }
        loaded.scenario.estimator.network = from_here(network)?;
        Ok(loaded)
    }

    /// Rows of the test grid.
    pub fn rows(&self, seed: u64) -> Rows {
        match self.rows {
            None => Rows::All(Grid::test()),
            Some(rows) => Rows::Subset(Subset::new(Grid::test(), rows, seed)),
        }
    }

    /// Rows of the test grid: so many random ones, if nothing else was asked for.
    pub fn rows_or(&self, rows: u64, seed: u64) -> Rows {
        Rows::Subset(Subset::new(Grid::test(), self.rows.unwrap_or(rows), seed))
    }

    /// Threads to draw on.
    pub fn pool(&self) -> Result<ThreadPool> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0).into());
        pool.build().map_err(|error| Input::new("--threads", error).into())
    }
}
