//! `tofsim estimate`: depths of histograms from files, bit for bit as the firmware computes them.

use std::path::PathBuf;

use serde::Serialize;

use tofsim::error::Result;
use tofsim::network::histogram_file;
use tofsim::network::{Estimate, Network, estimate};
use tofsim_learn::quantize::{Explanation, explain};

use crate::report::explanation;
use crate::text::table::{align_right, plain};

use super::stdout::{json_line, print};

/// Estimate depths of histograms, bit for bit as the firmware does
#[derive(Debug, clap::Args)]
pub struct Args {
    /// CSV with header bin,count and 256 rows, or .npy of 256 or n x 256 whole numbers
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Built-in network (uniform, uniform-16, ideal) or network file
    #[arg(long, value_name = "NAME|FILE", default_value = Network::DEFAULT)]
    network: String,
    /// Show every value of the datapath beside its twin in double precision, where they part, and
    /// what each rounding adds to the depth
    #[arg(long)]
    explain: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A line of the result.
#[derive(Serialize)]
struct Row<'a> {
    /// Place among all histograms of all files.
    index: usize,
    file: &'a str,
    #[serde(flatten)]
    numbers: Numbers,
    #[serde(skip_serializing_if = "Option::is_none")]
    explanation: Option<Explanation>,
}

#[derive(Clone, Serialize)]
struct Numbers {
    /// The 36-bit word in hexadecimal.
    depth_raw: String,
    depth_m: f64,
    /// Sums of the hidden neurons as integers, 23 fraction bits.
    l1_in: Vec<i64>,
}

#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    network: &'a str,
    /// The same again for scripts, if there is just one histogram.
    #[serde(flatten)]
    only: Option<Numbers>,
    histograms: &'a [Row<'a>],
}

/// Runs the verb.
pub fn run(args: &Args) -> Result<()> {
    let network = Network::find(&args.network, None)?;
    let params = network.params();
    let names: Vec<String> = args.files.iter().map(|file| file.display().to_string()).collect();
    let mut rows = Vec::new();
    for (path, file) in args.files.iter().zip(&names) {
        for histogram in histogram_file::open(path)? {
            let histogram = histogram?;
            let numbers = Numbers::of(&estimate(&params, &histogram), params.neurons());
            let explanation = args.explain.then(|| explain(&network, &histogram));
            rows.push(Row { index: rows.len(), file, numbers, explanation });
        }
    }
    if !args.json && args.explain {
        return print(&rows.iter().map(explained).collect::<Vec<_>>().join("\n"));
    }
    if !args.json {
        return print(
            &rows.chunks(TABLE).map(|rows| table(rows, names.len() > 1)).collect::<String>(),
        );
    }
    let only = if let [row] = &rows[..] { Some(row.numbers.clone()) } else { None };
    let schema = "tofsim.estimate/1";
    let report = Report { schema, network: &network.name, only, histograms: &rows };
    print(&json_line(&report)?)
}

impl Numbers {
    fn of(estimate: &Estimate, neurons: usize) -> Self {
        Numbers {
            depth_raw: format!("{:09x}", estimate.depth.bits()),
            depth_m: estimate.depth.to_f64(),
            l1_in: estimate.l1_in[..neurons].iter().map(|sum| sum.get()).collect(),
        }
    }
}

/// The values of one estimation, layer by layer.
fn explained(row: &Row) -> String {
    let text = row.explanation.as_ref().map(explanation::text).unwrap_or_default();
    let Numbers { depth_raw, depth_m, .. } = &row.numbers;
    format!("{} #{}: {depth_m:.6} m ({depth_raw})\n{text}", row.file, row.index)
}

/// Rows of a table; what has more goes into several.
const TABLE: usize = 10_000;

fn table(rows: &[Row], several: bool) -> String {
    let mut table = plain();
    let mut header = vec!["index", "depth_raw", "depth_m", "l1_in (23 fraction bits)"];
    header.extend(several.then_some("file"));
    table.set_header(header);
    for Row { index, file, numbers, .. } in rows {
        let sums = numbers.l1_in.iter().map(i64::to_string).collect::<Vec<_>>().join(" ");
        let depth_m = format!("{:.6}", numbers.depth_m);
        let mut cells = vec![index.to_string(), numbers.depth_raw.clone(), depth_m, sums];
        cells.extend(several.then(|| file.to_string()));
        table.add_row(cells);
    }
    align_right(&mut table, ..3);
    format!("{}\n", table.trim_fmt())
}
