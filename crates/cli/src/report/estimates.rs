//! Depths of histograms from files: tables and JSON.

use serde::Serialize;
use serde_json::{Value, json};

use tofsim::firmware::tof_top::status_code::StatusCode;
use tofsim::network::Network;
use tofsim::sim::estimates::{Estimate, digits};
use tofsim_learn::estimation::EstimatorKind;
use tofsim_learn::quantize::{ExplainedLikelihood, Explanation};

use crate::text::table::{number_or_dash, table};

use super::writer::Findings;
use super::{explanation, readings};

/// A line of the result.
#[derive(Serialize)]
pub struct Row<'a> {
    /// Place among all histograms of all files.
    pub index: usize,
    pub file: &'a str,
    #[serde(flatten)]
    pub numbers: Numbers,
    /// Second opinion, where there is one.
    pub second_opinion: Option<Estimate>,
    /// Results of the other estimators.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub estimates: Vec<Estimate>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explanation: Option<Explanation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub likelihood_explanation: Option<ExplainedLikelihood>,
}

/// Numbers of the estimator in the firmware.
#[derive(Serialize)]
pub struct Numbers {
    /// Its estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Sums of the hidden neurons as integers, with the fraction bits of their weights, if it is the network.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub l1_in: Option<Vec<i64>>,
}

/// Estimates of all histograms.
pub struct EstimateFindings<'a> {
    /// The network, if it is in the firmware.
    pub network: Option<&'a Network>,
    /// Bins of the sensor, if they are not the scenario's.
    pub sensor: Option<Value>,
    pub rows: Vec<Row<'a>>,
    /// Whether there are several files.
    pub several: bool,
    /// Whether people see every value of the datapath.
    pub explain: bool,
}

impl Findings for EstimateFindings<'_> {
    const SCHEMA: &'static str = "tofsim.estimate/1";

    fn json(&self) -> Value {
        let mut json = json!({ "histograms": self.rows });
        if let Some(network) = self.network {
            json["network"] = json!(network.name);
        }
        self.sensor.iter().for_each(|sensor| json["sensor"] = sensor.clone());
        // Once more for scripts, if there is just one histogram.
        if let [row] = &self.rows[..] {
            let numbers = json!(row.numbers);
            for key in ["depth_raw", "depth_m", "l1_in"] {
                numbers.get(key).into_iter().for_each(|value| json[key] = value.clone());
            }
        }
        json
    }

    fn text(&self) -> String {
        if self.explain {
            return self.rows.iter().map(explained).collect::<Vec<_>>().join("\n");
        }
        self.rows.chunks(TABLE).map(|rows| rows_table(rows, self.several)).collect()
    }
}

impl Numbers {
    fn depth_m(&self) -> f64 {
        self.estimate.depth_m.unwrap_or(f64::NAN)
    }

    fn depth_raw(&self) -> String {
        self.estimate.depth_raw.map(digits).unwrap_or_default()
    }
}

/// The values of one estimation, layer by layer, or stage by stage.
fn explained(row: &Row) -> String {
    let Row { index, file, numbers, .. } = row;
    let (depth_m, depth_raw) = (numbers.depth_m(), numbers.depth_raw());
    let network = row.explanation.as_ref().map(|of| {
        format!("{file} #{index}: {depth_m:.6} m ({depth_raw})\n{}", explanation::network(of))
    });
    let likelihood = row.likelihood_explanation.as_ref().map(|of| {
        let ExplainedLikelihood { depth_raw, depth_m, sigma_m, .. } = of;
        let name = EstimatorKind::LikelihoodEstimator.name();
        let text = explanation::likelihood(of);
        format!("{file} #{index}: {depth_m:.6} m ({depth_raw}), {name}, sd {sigma_m:.6} m\n{text}")
    });
    network.into_iter().chain(likelihood).collect::<Vec<_>>().join("\n")
}

/// Rows of a table; what has more goes into several.
const TABLE: usize = 10_000;

fn rows_table(rows: &[Row], several: bool) -> String {
    let first = rows.first();
    let mut header = vec!["index", "depth_m", "sd_mm", "status", "word"];
    header.extend(first.and_then(|row| row.second_opinion.as_ref()).map(|_| "second opinion"));
    header.extend(first.into_iter().flat_map(|row| &row.estimates).map(|one| one.estimator));
    header.extend(several.then_some("file"));
    let rows = rows.iter().map(|row| {
        let Numbers { estimate, .. } = &row.numbers;
        let mut cells = vec![row.index.to_string(), number_or_dash(estimate.depth_m, 6)];
        cells.extend([number_or_dash(estimate.sigma_m.map(|m| 1e3 * m), 3), in_word(estimate)]);
        cells.push(estimate.depth_raw.map_or("-".to_owned(), digits));
        cells.extend(row.second_opinion.iter().map(|opinion| {
            let depth = number_or_dash(opinion.depth_m, 6);
            if opinion.valid { depth } else { format!("rejected: {}", opinion.status) }
        }));
        let depth = |reading| readings::said(reading, |depth_m| format!("{depth_m:.6}"));
        cells.extend(row.estimates.iter().map(depth));
        cells.extend(several.then(|| row.file.to_owned()));
        cells
    });
    table(header, rows, ..4) + "\n"
}

/// The status of an estimate: `valid`, its reasons, or a dash where the estimator states none.
fn in_word(estimate: &Estimate) -> String {
    if let Some(failure) = &estimate.failure {
        failure.clone()
    } else if let Some(why) = estimate.rejection() {
        why
    } else if estimate.sigma_m.is_some() {
        let code = if estimate.status_code.is_unstated() {
            StatusCode::Valid
        } else {
            estimate.status_code
        };
        code.word().to_owned()
    } else {
        "-".to_owned()
    }
}
