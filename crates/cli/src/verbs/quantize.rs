//! `tofsim quantize`: a network that was trained elsewhere, in the words of the firmware.

use std::path::{Path, PathBuf};

use serde_json::json;

use tofsim::error::{Error, Result};
use tofsim::files::output::{create_directory, write_bytes};
use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::firmware::histogram_builder::Params;
use tofsim::kernel::Overflow;
use tofsim::network::file::Training;
use tofsim::network::unrounded::Unrounded;
use tofsim::network::{Network, mem};
use tofsim::scenario;
use tofsim::sim::domain;
use tofsim_learn::dataset::GridPurpose;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::evaluation::exploration::{explore, sweep};
use tofsim_learn::evaluation::thesis;
use tofsim_learn::quantize::import;

use crate::report::exploration::Exploration;
use crate::report::writer::Report;
use crate::text::table::table;

use super::draws::Draws;
use super::formats::Formats;
use super::scenes::Scenes;
use super::terminal::{Console, print_json, stop_signal};

/// Histograms of an exploration, if nothing else is said: 200 at each distance.
const EXPLORED: u64 = 10_200;

/// Fold and round a network trained elsewhere, or explore word lengths
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Arrays by name, for N hidden neurons, 1 to 32: IW (N x bins), LW (N), b1 (N), b2 (1), and the settings \
    of mapminmax on both sides, if any: x_xoffset, x_gain (bins each), x_ymin, y_xoffset, y_gain, y_ymin; x_keep holds \
    the bins, from 1, that removeconstantrows kept. In MATLAB:\n\n  \
    s = net.inputs{1}.processSettings{2}; t = net.outputs{2}.processSettings{2};\n  \
    IW = net.IW{1,1}; LW = net.LW{2,1}; b1 = net.b{1}; b2 = net.b{2};\n  \
    x_xoffset = s.xoffset; x_gain = s.gain; x_ymin = s.ymin;\n  \
    y_xoffset = t.xoffset; y_gain = t.gain; y_ymin = t.ymin;\n  \
    save('net.mat', 'IW', 'LW', 'b1', 'b2', 'x_*', 'y_*', '-v7')\n\n\
    JSON: {\"IW\": [[...], ...], \"LW\": [...], \"b\": [[...], [...]],\n       \
    \"x\": {\"xoffset\": [...], \"gain\": [...], \"ymin\": -1}, \"y\": {...}}\n\n\
    Examples:\n  \
    tofsim quantize --from net.mat -o net.toml --roms roms\n  \
    tofsim run -s estimator.network=net.toml"
)]
pub struct Args {
    #[command(flatten)]
    task: Task,
    /// Network file to write
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the ROMs for $readmemh into this folder: w1.mem, b1.mem, w2.mem, b2.mem, tansig.mem
    #[arg(long, value_name = "DIR")]
    roms: Option<PathBuf>,
    /// Chain whose bins it was trained on, for the file
    #[arg(long, value_name = "P", default_value = "unknown")]
    chain: String,
    /// Description of the network, for the file
    #[arg(long, value_name = "TEXT", default_value = "depth network, trained elsewhere")]
    description: String,
    #[command(flatten)]
    formats: Formats,
    /// Saturate weights that do not fit, instead of an error
    #[arg(long)]
    saturate: bool,
    /// Built-in scenario, or the path of a scenario file, to explore with
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    draws: Draws,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Task {
    /// Fold and round a network: MATLAB file, JSON file, or folder of NumPy arrays (IW.npy, ...)
    #[arg(long, value_name = "FILE|DIR", conflicts_with_all = ["scenario", "Draws"])]
    from: Option<PathBuf>,
    /// Sweep word lengths and the table of activations: accuracy against block RAMs and DSP slices; on 10,200
    /// histograms unless --rows is given
    #[arg(long, value_name = "NETWORK", conflicts_with_all = ["output", "roms", "chain", "description", "saturate", "Formats"])]
    explore: Option<String>,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    match (&args.task.from, &args.task.explore) {
        (Some(from), _) => quantize(args, from, console),
        (None, explore) => args.explore(explore.as_deref(), console),
    }
}

fn quantize(args: &Args, path: &Path, console: &Console) -> Result<()> {
    let from = path.display().to_string();
    let size = scenario::load(&args.scenario, &args.draws.set)?.scenario.histogram();
    let float = import::read(path, size.bins)?;
    let overflow = if args.saturate { Overflow::Saturate } else { Overflow::Refuse };
    let mut datapath = Datapath::THESIS;
    args.formats.put_over(&mut datapath);
    args.formats.check(&datapath)?;
    let rounded = float.round(&from, &datapath, overflow)?;
    if rounded.saturated > 0 {
        console.note(format_args!("note: {} weights were saturated", rounded.saturated));
    }
    let magnitude =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |a, b| f64::max(a, b.abs()));
    // Largest magnitude of each kind of weights, and what its word holds.
    let largest = [
        ("w1", magnitude(&mut float.w1.iter().flatten().copied()), datapath.w1.range()),
        ("b1", magnitude(&mut float.b1.iter().copied()), datapath.b1.range()),
        ("w2", magnitude(&mut float.w2.iter().copied()), datapath.w2.range()),
        ("b2", float.b2.abs(), datapath.b2.range()),
    ];
    let network = Network {
        name: from.clone(),
        description: args.description.clone(),
        training: Training {
            origin: format!("trained elsewhere, from {}", file_name(path)),
            chain: args.chain.clone(),
            ..Training::default()
        },
        domain: None,
        accuracy: None,
        datapath,
        fixed: rounded.fixed,
        float: Unrounded::Known(float),
    };
    let files = args.write(&network)?;
    files.iter().for_each(|path| console.wrote(path));
    let files: Vec<_> = files.iter().map(|path| path.display().to_string()).collect();
    if args.json {
        return print_json(&json!({
            "schema": "tofsim.quantize/1",
            "from": from,
            // Weights that no word holds.
            "saturated": rounded.saturated,
            "largest": largest.map(|(weights, magnitude, limit)| {
                json!({ "weights": weights, "magnitude": magnitude, "limit": limit })
            }),
            "files": files,
        }));
    }
    let rows = largest.map(|(weights, magnitude, limit)| {
        [weights.to_owned(), format!("{magnitude:.6}"), format!("below {limit}")]
    });
    let table = table(["weights", "largest", "word holds"], rows, ..0);
    console.report(&format!("{table}\nsaturated: {}\n", rounded.saturated))
}

impl Args {
    fn explore(&self, network: Option<&str>, console: &Console) -> Result<()> {
        let load = |set: &[String]| self.draws.load_with(&self.scenario, network, set);
        let scenes = Scenes::new(&[], &self.draws.set, GridPurpose::Test, load)?;
        scenes.check_single("--explore")?;
        let Scenes { grid, setups, source, .. } = scenes;
        let (setup, network) = (&setups[0], &setups[0].network);
        setup.check_network()?;
        let (seed, profile) = (setup.scenario.seed, &setup.scenario.tdc.profile);
        let notes = domain::notes(network, &setup.scenario, &grid.ranges())?;
        console.print_notes(&notes)?;
        let distances_m = if grid.is_thesis() {
            thesis::DISTANCES_M.to_vec()
        } else {
            thinned(&grid.distances_m.values, thesis::DISTANCES_M.len())
        };
        let rows = self.draws.rows(Some(EXPLORED), &grid, seed)?;
        let (stop, data) = (stop_signal(), (&source, &rows, seed));
        let points = self.draws.on_threads(rows.count(), console, |done| {
            let datapaths = sweep(&network.datapath);
            explore(network, &datapaths, data, &distances_m, stop.as_deref(), done)
        })?;
        let findings = Exploration {
            network: &network.name,
            profile,
            rows: rows.count(),
            distances_m: &distances_m,
            points: &points,
            seed,
        };
        Report::new(findings, setup, &notes, console).deliver(None, self.json, console)
    }

    fn write(&self, network: &Network) -> Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        let mut put = |path: PathBuf, text: &str| {
            write_bytes(&path, text)?;
            files.push(path);
            Ok::<(), Error>(())
        };
        if let Some(path) = &self.output {
            put(path.clone(), &network.to_toml())?;
        }
        if let Some(folder) = &self.roms {
            create_directory(folder)?;
            let size = Params { bins: network.fixed.bins(), ..Params::default() };
            for rom in mem::depth_estimator(&network.params(&size)) {
                put(folder.join(&*rom.name), &rom.text)?;
            }
        }
        Ok(files)
    }
}

/// Without the folders before it, which are nobody's business in the file.
fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
