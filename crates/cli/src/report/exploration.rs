//! Accuracy against cost as a table.

use serde::Serialize;
use serde_json::{Value, json};

use tofsim_learn::evaluation::exploration::ExploredDatapath;

use crate::text::table::{fitted, number_or_dash, width};

use super::writer::Findings;

/// A spread is as good as another if it is at most so many times as large at every distance.
const AS_GOOD: f64 = 1.02;

/// Accuracy and cost of datapaths.
#[derive(Serialize)]
pub struct Exploration<'a> {
    /// Name of the network.
    pub network: &'a str,
    /// Chain on whose bins histograms were drawn.
    pub profile: &'a str,
    /// Number of histograms.
    pub rows: u64,
    /// Distances of the spreads [m].
    pub distances_m: &'a [f64],
    /// The datapaths.
    pub points: &'a [ExploredDatapath],
    /// Seed of the histograms.
    #[serde(skip)]
    pub seed: u64,
}

impl Findings for Exploration<'_> {
    const SCHEMA: &'static str = "tofsim.exploration/1";

    fn json(&self) -> Value {
        json!(self)
    }

    fn text(&self) -> String {
        let Exploration { network, profile, rows, seed, .. } = self;
        let head =
            format!("network {network}, chain {profile}, {rows} histograms, seed {seed}\n\n");
        head + &text(self.points, self.distances_m, width())
    }
}

/// Returns a summary and a table with a row for each datapath, in lines of `width` characters.
fn text(points: &[ExploredDatapath], distances_m: &[f64], width: usize) -> String {
    let distances: Vec<_> =
        distances_m.iter().map(|distance_m| format!("{distance_m} m")).collect();
    let costs =
        ["rms to float", "largest", "weights cut", "sums past table", "bits", "RAMs", "DSP48"];
    let header = [&["datapath".to_owned()], &distances[..], &costs.map(str::to_owned)].concat();
    let rows = points.iter().map(|point| {
        let mut cells = vec![point.variant.clone()];
        cells.extend(point.two_sd_mm.iter().map(|mm| number_or_dash(*mm, 2)));
        let [hidden, depth] = point.sum_bits;
        cells.extend([
            format!("{:.3}", point.rms_to_float_mm),
            format!("{:.2}", point.largest_to_float_mm),
            point.saturated_weights.to_string(),
            format!("{:.2}", point.saturated_sums),
            format!("{hidden} {depth}"),
            point.cost.block_rams().to_string(),
            point.cost.dsp48.to_string(),
        ]);
        cells
    });
    let rows: Vec<_> = rows.collect();
    let notes = [
        "two standard deviations of the depth at each distance, and what is between fixed",
        "point and float, in mm; weights that no word holds are cut to the nearest; sums",
        "past the table of each histogram's, one a neuron; bits of the sums of the hidden",
        "layer and of the depth; block RAMs of 36 Kb, a half for one of 18 Kb",
    ];
    format!("{}\n{}\n\n{}\n", summary(points), fitted(&header, &rows, width), notes.join("\n"))
}

/// The firmware's own, the cheapest that measures as well, and the nearest to float.
fn summary(points: &[ExploredDatapath]) -> String {
    let line = |what: &str, point: &ExploredDatapath| {
        let (rams, slices) = (point.cost.block_rams(), point.cost.dsp48);
        let rms_mm = point.rms_to_float_mm;
        format!(
            "{what}: {}\n  {rams} block RAMs, {slices} DSP slices, {rms_mm:.3} mm rms to float\n",
            point.variant
        )
    };
    let Some(own) = points.first() else { return String::new() };
    let is_as_good = |point: &&ExploredDatapath| {
        point.two_sd_mm.iter().zip(&own.two_sd_mm).all(|pair| match pair {
            (Some(mm), Some(own_mm)) => *mm <= AS_GOOD * own_mm,
            (mm, own_mm) => mm == own_mm,
        })
    };
    let price =
        |point: &&ExploredDatapath| (2 * point.cost.ramb36 + point.cost.ramb18, point.cost.dsp48);
    let cheapest = points.iter().filter(is_as_good).min_by_key(price).unwrap_or(own);
    let distance = |point: &&ExploredDatapath| point.rms_to_float_mm;
    let nearest = points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(own);
    line("built", own)
        + &line("cheapest within 2 % of its spread", cheapest)
        + &line("nearest to float", nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim_learn::evaluation::thesis::DISTANCES_M;
    use tofsim_learn::quantize::Cost;

    fn point(variant: &str, mm: f64, rams: (u32, u32), rms_to_float_mm: f64) -> ExploredDatapath {
        ExploredDatapath {
            variant: variant.to_owned(),
            two_sd_mm: vec![Some(mm); DISTANCES_M.len()],
            rms_to_float_mm,
            largest_to_float_mm: 12.345,
            saturated_weights: 0,
            saturated_sums: 0.81,
            sum_bits: [36, 36],
            cost: Cost { ramb36: rams.0, ramb18: rams.1, dsp48: 10 },
        }
    }

    #[test]
    fn the_summary_comes_first_and_every_line_fits() {
        let points = [
            point("the network's own", 10.0, (10, 0), 0.4),
            point("table of 10 address bits over +-4", 10.1, (2, 5), 0.9),
            point("table of 12 address bits over +-8", 12.5, (2, 0), 0.2),
        ];
        let text = text(&points, &DISTANCES_M, 80);
        assert!(
            text.starts_with("built: the network's own\n  10 block RAMs, 10 DSP slices, 0.400 mm")
        );
        assert!(
            text.contains("spread: table of 10 address bits over +-4\n  4.5 block RAMs"),
            "{text}"
        );
        assert!(text.contains("nearest to float: table of 12 address bits over +-8\n"), "{text}");
        let longest = text.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(80), "{longest:?}: {text}");
    }
}
