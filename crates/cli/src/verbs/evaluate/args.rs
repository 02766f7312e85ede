//! The options of `tofsim evaluate`.

use std::path::PathBuf;

use tofsim::scenario;
use tofsim_learn::estimation::EstimatorKind;

use crate::choice::words;
use crate::verbs::draws::Draws;

/// Distances of the tables, where the grid is not the thesis's.
pub(super) const SHOWN: usize = 6;

/// Measure the accuracy of the network and other estimators
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "By default, new histograms are drawn over the thesis's test grid: 51 distances from \
    0.1 to 0.6 m, 9 irradiances, 53 reflectances, 5 of each scene. All estimators receive the same histograms, except \
    subtraction: a dark and a lit one of half the shots each. --grid KEY=... sets your own scenes; keys without --grid \
    are those of the scenario. An array is measured pixel by pixel, by default in its own scene.\n\n\
    Examples:\n  \
    tofsim evaluate                                 the network of the scenario\n  \
    tofsim evaluate ideal --profile ideal -o out    with box plots and CSV\n  \
    tofsim evaluate --estimator network,peak,matched,likelihood --rows 12000\n  \
    tofsim evaluate --estimator peak,subtraction    with and without a dark frame\n  \
    tofsim evaluate --data measured --profile chain.toml   your own histograms\n  \
    tofsim evaluate --grid target.distance_m=0.1..0.9:0.05 --repeats 100\n  \
    tofsim evaluate --scenario array --repeats 20   the pixels of an array"
)]
pub struct Args {
    /// Built-in network, such as uniform-16, or network file [default: the scenario's]
    #[arg(value_name = "NETWORK")]
    pub(super) network: Option<String>,
    /// Built-in scenario, or the path of a scenario file, for all but the scene
    #[arg(long, default_value = scenario::DEFAULT)]
    pub(super) scenario: String,
    #[command(flatten)]
    pub(super) draws: Draws,
    /// Estimators, separated by commas [default: that of the scenario's firmware, and its network in double precision]
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',')]
    pub(super) estimator: Vec<EstimatorKind>,
    /// Which scenes: thesis or test (51 distances, every 10 mm), train (201), KEY=FROM..TO:STEP or KEY=A,B,C
    /// of any numeric key of the scenario (may be repeated), or a TOML file of those [default: the scenario's
    /// training.grid, or else thesis]
    #[arg(long, value_name = "GRID")]
    pub(super) grid: Vec<String>,
    /// Histograms per scene, unless --rows is given
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) repeats: u64,
    /// Histograms of known distances instead of drawn ones: the folder of a dataset, a Parquet file with
    /// columns b0 to b255 and distance_m, or an .npy file with --truth
    #[arg(long, value_name = "PATH", conflicts_with_all = ["grid", "repeats", "rows"])]
    pub(super) data: Option<PathBuf>,
    /// The true distances of --data [m]: an .npy file of n or n x k floats, distances first
    #[arg(long, value_name = "FILE", requires = "data")]
    pub(super) truth: Option<PathBuf>,
    /// Frames to simulate cycle by cycle at each of six distances, to be compared with the fast path
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub(super) check: u64,
    /// Error above which an estimate is an outlier [mm]
    #[arg(long, value_name = "MM", default_value_t = 100.0, value_parser = crate::choice::millimetres)]
    pub(super) outlier_limit_mm: f64,
    /// Write evaluation.json, evaluation.csv, box plots of the errors, and the spread by distance over the Cramer-Rao
    /// bound into this folder
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub(super) json: bool,
}
