//! Accuracy against cost as a table.

use tofsim_learn::evaluation::exploration::ExploredDatapath;
use tofsim_learn::evaluation::thesis::DISTANCES_M;

use crate::text::table::{number_or_dash, table};

/// A row for each datapath.
pub fn text(points: &[ExploredDatapath]) -> String {
    let distances = DISTANCES_M.map(|distance_m| format!("2 sd {distance_m} m"));
    let costs =
        ["rms to float", "largest", "weights cut", "sums past table", "bits", "RAMB36", "DSP48"];
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
            point.cost.ramb36.to_string(),
            point.cost.dsp48.to_string(),
        ]);
        cells
    });
    table(header, rows, 1..)
        + "\n\n2 sd and differences in mm; weights that no word holds are cut to the nearest; sums past \
         the table of each histogram's 8;\nbits of the sums of the hidden layer and of the depth\n"
}
