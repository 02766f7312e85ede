//! A plan as its TOML file has it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PlanFile {
    /// What it is for, in a sentence.
    pub description: String,
    /// Built-in scenario, or the path of one from the plan's folder.
    pub scenario: String,
    /// Keys of the scenario that are the same at all points, as `key=value`.
    pub set: Vec<String>,
    /// How the axes make points.
    pub combine: Combine,
    /// Points of a Latin hypercube.
    #[schemars(range(min = 1))]
    pub samples: Option<u64>,
    /// What is simulated at each point.
    pub fidelity: Fidelity,
    /// Frames of each repeat, or pairs of a dark and a lit one.
    #[schemars(range(min = 1, max = 1_000_000_000))]
    pub frames: u64,
    /// How often each point is worked out, each time with other random numbers.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub repeats: u64,
    /// Seed of every random number; without it, the scenario's.
    #[schemars(range(min = 0))]
    pub seed: Option<u64>,
    /// Whether all points have the same random numbers.
    pub common_random_numbers: bool,
    /// Estimators by name; without any, the one in the firmware.
    pub estimators: Vec<String>,
    /// An error above that is an outlier [mm].
    #[schemars(range(min = 1e-6, max = 1e9))]
    pub outlier_limit_mm: f64,
    /// Columns of the table, with `*`; without any, all that the fidelity gives.
    pub outputs: Vec<String>,
    /// What becomes of a point that the scenario refuses.
    pub refused: Refused,
    /// Keys with their values; the last one changes fastest.
    pub axis: Vec<AxisFile>,
    /// Scenes of each point, over all of which its values are means.
    pub mean_over: Vec<AxisFile>,
    /// What is looked for at each point.
    pub search: Option<SearchFile>,
    /// The picture.
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

/// How axes make points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Combine {
    /// Every value of one with every value of the others.
    Product,
    /// The first values of all, the second values of all, and so on.
    Zip,
    /// As many points as asked for, each axis cut into so many equally likely parts with one point in each
    /// (McKay, Beckman and Conover, Technometrics 21, 1979).
    LatinHypercube,
}

/// What is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fidelity {
    /// Nothing: the link budget alone.
    Budget,
    /// Whole frames, drawn at once.
    Histogram,
    /// Shot by shot, from one event to the next.
    Shot,
    /// Cycle by cycle.
    Cycle,
}

/// What becomes of a point that the scenario refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Refused {
    /// The sweep ends with an error; what is finished stays.
    Stop,
    /// Its row has the reason and nothing else.
    Keep,
}

/// A key and its values: a list, a range with steps, a range with a number of values, or a distribution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisFile {
    /// Key of the scenario, such as `target.distance_m`.
    pub key: String,
    /// The values: numbers, words or switches.
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    pub values: Option<Vec<Value>>,
    /// The values as `FROM..TO:STEP`.
    pub range: Option<String>,
    /// The first value of a range.
    pub from: Option<f64>,
    /// The last one.
    pub to: Option<f64>,
    /// Values of a range, or draws of a distribution.
    #[schemars(range(min = 1))]
    pub count: Option<u64>,
    /// How the values of a range lie.
    pub scale: Option<Scale>,
    /// What values are drawn from; `from` and `to` bound it, but for the normal one, where they cut it off.
    pub distribution: Option<Distribution>,
    /// Of a normal distribution, or of the logarithm's where that is normal.
    pub mean: Option<f64>,
    /// Standard deviation of the same.
    pub sd: Option<f64>,
    /// Most likely value of a triangular distribution.
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

/// How the values of a range lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equally far apart.
    #[default]
    Linear,
    /// Each by the same factor larger.
    Log,
}

/// What values are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Equally likely from `from` to `to`.
    Uniform,
    /// The same of the logarithm.
    LogUniform,
    /// With `mean` and `sd`.
    Normal,
    /// Its logarithm (base e) has `mean` and `sd`.
    LogNormal,
    /// From `from` to `to`, most likely at `mode`.
    Triangular,
}

/// What is looked for: the end of the stretch of a key's values where limits are met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SearchFile {
    /// Key of the scenario.
    pub key: String,
    /// Which end.
    pub find: Find,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// How near the answer is to come, in the key's unit; of a logarithmic scale, as a part of the value.
    pub resolution: f64,
    /// How the first look's steps lie.
    #[serde(default)]
    pub scale: Scale,
    /// Steps of the first look, from which on the interval is halved.
    #[serde(default = "steps")]
    #[schemars(range(min = 1, max = 100_000))]
    pub steps: u64,
    /// Limits such as `peak.failure_rate < 0.1`, all of which have to be met.
    pub meets: Vec<String>,
    /// Scenes in all of which they have to be met.
    #[serde(default)]
    pub over: Vec<AxisFile>,
}

fn steps() -> u64 {
    10
}

/// Which end of a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Find {
    /// The largest value up to which, from the first one on, the limits are met.
    Largest,
    /// The least value at which they are met.
    Least,
}

/// A picture of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// Words above it.
    pub title: String,
    /// Column along the horizontal axis.
    pub x: String,
    /// Columns along the vertical axis; of a surface one, the colour being the last.
    pub y: Vec<String>,
    /// Columns whose values have a line each.
    #[serde(default)]
    pub series: Vec<String>,
    /// What is drawn.
    #[serde(default)]
    pub kind: PlotKind,
    /// Whether the horizontal axis is logarithmic.
    #[serde(default)]
    pub log_x: bool,
    /// Whether the vertical axis is logarithmic.
    #[serde(default)]
    pub log_y: bool,
    /// Words along the horizontal axis; without them, the column's name.
    pub x_label: Option<String>,
    /// Words along the vertical axis; without them, the columns' names.
    pub y_label: Option<String>,
    /// Limits that are drawn in.
    #[serde(default)]
    pub limits: Vec<LimitLine>,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlotKind {
    /// A line for each column and series, with standard errors where they are known.
    #[default]
    Lines,
    /// A cell for each point: `x` across, the first of `y` up, the second as its colour.
    Surface,
}

/// A limit in a picture, at one value of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitLine {
    /// Where on the horizontal axis.
    pub x: Option<f64>,
    /// Where on the vertical axis.
    pub y: Option<f64>,
    /// What it is.
    pub label: String,
}
