//! Contents of a plan's TOML file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use tofsim::sim::Stepping;

/// A plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PlanFile {
    /// Purpose of the plan, in a sentence.
    pub description: String,
    /// Built-in scenario, or a path relative to the plan's folder.
    pub scenario: String,
    /// Overrides of the scenario's keys for all points, as `key=value`.
    pub set: Vec<String>,
    /// Combination of the axes to points.
    pub combine: Combine,
    /// Number of points of a Latin hypercube.
    #[schemars(range(min = 1))]
    pub samples: Option<u64>,
    /// Simulation fidelity.
    pub fidelity: Fidelity,
    /// Number of frames per repeat, of pairs of a dark and a lit frame, or of images of an array.
    #[schemars(range(min = 1, max = 1_000_000_000))]
    pub frames: u64,
    /// Number of repeats of each point, with different random numbers.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub repeats: u64,
    /// Seed of all random numbers; the scenario's by default.
    #[schemars(range(min = 0))]
    pub seed: Option<u64>,
    /// Whether all points use the same random numbers.
    pub common_random_numbers: bool,
    /// Estimators by name; the firmware's by default.
    pub estimators: Vec<String>,
    /// Error beyond which a depth is an outlier [mm].
    #[schemars(range(min = 1e-6, max = 1e9))]
    pub outlier_limit_mm: f64,
    /// Columns of the table, with wildcard `*`; all that the fidelity provides by default.
    pub outputs: Vec<String>,
    /// Treatment of points that the scenario refuses.
    pub refused: Refused,
    /// Keys with their values; the last one changes fastest.
    pub axis: Vec<AxisFile>,
    /// Scenes over which each point is averaged.
    pub mean_over: Vec<AxisFile>,
    /// Search at each point.
    pub search: Option<SearchFile>,
    /// Plot of the table.
    pub plot: Option<Plot>,
}

impl Default for PlanFile {
    fn default() -> Self {
        PlanFile {
            description: String::new(),
            scenario: tofsim::scenario::DEFAULT.to_owned(),
            set: Vec::new(),
            combine: Combine::Product,
            samples: None,
            fidelity: Fidelity::Histogram,
            frames: 100,
            repeats: 1,
            seed: None,
            common_random_numbers: false,
            estimators: Vec::new(),
            outlier_limit_mm: 100.0,
            outputs: Vec::new(),
            refused: Refused::Stop,
            axis: Vec::new(),
            mean_over: Vec::new(),
            search: None,
            plot: None,
        }
    }
}

/// Combination of axes to points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Combine {
    /// Cartesian product of all axes.
    Product,
    /// Pairwise: the first values of all axes, the second values of all, and so on.
    Zip,
    /// Latin hypercube: each axis is divided into as many equally probable intervals as there are points, with one
    /// point in each (McKay, Beckman and Conover, Technometrics 21, 1979).
    LatinHypercube,
}

/// Simulation fidelity of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fidelity {
    /// No simulation, only the link budget.
    Budget,
    /// Whole frames, each drawn at once.
    Histogram,
    /// Shot by shot, from one event to the next.
    Shot,
    /// Cycle by cycle.
    Cycle,
}

impl Fidelity {
    /// How shots are simulated, if they are.
    pub fn stepping(self) -> Option<Stepping> {
        match self {
            Fidelity::Shot => Some(Stepping::LeapShots),
            Fidelity::Cycle => Some(Stepping::SkipIdle),
            Fidelity::Budget | Fidelity::Histogram => None,
        }
    }
}

/// Treatment of a point that the scenario refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Refused {
    /// The sweep ends with an error, and keeps finished points.
    Stop,
    /// The point's row contains only the reason.
    Keep,
}

/// A key and its values: a list, a range with a step, a range with a number of values, or a distribution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisFile {
    /// Key of the scenario, such as `target.distance_m`.
    pub key: String,
    /// Listed values: numbers, words or switches.
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    pub values: Option<Vec<Value>>,
    /// Range of values as `FROM..TO:STEP`.
    pub range: Option<String>,
    /// First value of a range.
    pub from: Option<f64>,
    /// Last value of a range.
    pub to: Option<f64>,
    /// Number of values of a range, or of draws from a distribution.
    #[schemars(range(min = 1))]
    pub count: Option<u64>,
    /// Spacing of a range's values.
    pub scale: Option<Scale>,
    /// Distribution of random values between `from` and `to`; a normal distribution is truncated there.
    pub distribution: Option<Distribution>,
    /// Mean of a normal distribution, or of the logarithm for a log-normal one.
    pub mean: Option<f64>,
    /// Standard deviation of a normal distribution, or of the logarithm for a log-normal one.
    pub sd: Option<f64>,
    /// Mode of a triangular distribution.
    pub mode: Option<f64>,
}

/// A value of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A whole number.
    Integer(i64),
    /// A number.
    Float(f64),
    /// A switch.
    Flag(bool),
    /// A word or a name.
    Text(String),
}

/// Spacing of a range's values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

/// Distribution of random values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Uniform from `from` to `to`.
    Uniform,
    /// Uniform logarithm.
    LogUniform,
    /// Normal with `mean` and `sd`.
    Normal,
    /// Log-normal: the natural logarithm has `mean` and `sd`.
    LogNormal,
    /// Triangular from `from` to `to`, with its mode at `mode`.
    Triangular,
}

/// A search for the end of the range of a key's values in which limits are met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SearchFile {
    /// Key of the scenario.
    pub key: String,
    /// End of the range to find.
    pub find: Find,
    /// Start of the search.
    pub from: f64,
    /// End of the search.
    pub to: f64,
    /// Accuracy of the answer, in the key's unit; relative on a logarithmic scale.
    pub resolution: f64,
    /// Spacing of the initial steps.
    #[serde(default)]
    pub scale: Scale,
    /// Number of initial steps, before bisection.
    #[serde(default = "steps")]
    #[schemars(range(min = 1, max = 100_000))]
    pub steps: u64,
    /// Limits such as `peak.failure_rate < 0.1`, all of which must be met.
    pub meets: Vec<String>,
    /// Scenes in all of which the limits must be met.
    #[serde(default)]
    pub over: Vec<AxisFile>,
}

fn steps() -> u64 {
    10
}

/// End of the range to find.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Find {
    /// The largest value up to which, from the first value on, the limits are met.
    Largest,
    /// The smallest value at which the limits are met.
    Least,
}

/// Plot of a sweep's table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Column on the horizontal axis.
    pub x: String,
    /// Columns on the vertical axis; for a surface, the vertical axis and the colour.
    pub y: Vec<String>,
    /// Columns whose values have a line each.
    #[serde(default)]
    pub series: Vec<String>,
    /// Kind of plot.
    #[serde(default)]
    pub kind: PlotKind,
    /// Whether the horizontal axis is logarithmic.
    #[serde(default)]
    pub log_x: bool,
    /// Whether the vertical axis is logarithmic.
    #[serde(default)]
    pub log_y: bool,
    /// Label of the horizontal axis; the column's name by default.
    pub x_label: Option<String>,
    /// Label of the vertical axis; the columns' names by default.
    pub y_label: Option<String>,
    /// Limits to draw.
    #[serde(default)]
    pub limits: Vec<LimitLine>,
}

/// Kind of plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlotKind {
    /// A line for each column and series, with standard errors if they are known.
    #[default]
    Lines,
    /// A coloured cell for each point: `x` is horizontal, the first of `y` vertical, and the second the colour.
    Surface,
}

/// A limit in a plot, at one value of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitLine {
    /// Position on the horizontal axis.
    pub x: Option<f64>,
    /// Position on the vertical axis.
    pub y: Option<f64>,
    /// Label.
    pub label: String,
}
