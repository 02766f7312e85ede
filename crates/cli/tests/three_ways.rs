//! Ten thousand histograms, random and extreme, through the clocked Rust block, the Verilog and
//! `tofsim estimate`: the same depth word from all three, with eight neurons and with sixteen.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

use tofsim::firmware::depth_estimator::{DepthEstimator, In, Params};
use tofsim::firmware::tof_top::slot::SlotEstimator;
use tofsim::kernel::U;
use tofsim::network::mem::{self, Mem, lines};
use tofsim::network::{Histogram, Network};
use tofsim_rtl::verify::process::Limits;
use tofsim_rtl::verify::{Rtl, Simulator};

use crate::common;

mod likelihood;

const HISTOGRAMS: usize = 10_000;
/// Most hits of a histogram.
const HITS: u32 = u16::MAX as u32;

const BENCH: &str = r#"`timescale 1ps / 1fs
module bench;
    reg clk_sys = 1'b0, rst = 1'b1, algo_start = 1'b0;
    wire read_en, algo_done;
    WIRES
    wire [7:0] read_addr;
    wire signed [35:0] depth;
    integer n = 0, edges = 0;
    reg [15:0] words [0:HISTOGRAMS * 256 - 1];
    wire [15:0] count = read_en ? words[256 * n + read_addr] : 16'd0;

    MODULE dut (
        .clk_sys(clk_sys), .rst(rst), .algo_start(algo_start), .count(count), PORTS
        .read_en(read_en), .read_addr(read_addr), .depth(depth), .algo_done(algo_done)
    );

    always #4000 clk_sys = !clk_sys;

    initial begin
        $readmemh("histograms.mem", words);
        repeat (2) @(negedge clk_sys);
        rst = 1'b0;
        while (n < HISTOGRAMS) begin
            algo_start = 1'b1;
            @(negedge clk_sys) algo_start = 1'b0;
            edges = 0;
            while (!algo_done) @(negedge clk_sys) edges = edges + 1;
            $display("found %h %0d SHOWN", depth, edges VALUES);
            n = n + 1;
        end
        $finish;
    end
endmodule
"#;

/// One bin, few bins, level, alternating and empty ones, and of the rest half as measured and half of
/// words of any size.
fn histograms() -> Vec<Histogram> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let of = |word: &dyn Fn(usize) -> u32| (0..256).map(word).collect::<Histogram>();
    let one = |bin: usize, count| of(&|k| if k == bin { count } else { 0 });
    let mut list = vec![vec![0; 256], vec![255; 256], of(&|k| if k % 2 == 0 { 511 } else { 0 })];
    list.extend((0..256).flat_map(|bin| [one(bin, HITS), one(bin, 1)]));
    while list.len() < HISTOGRAMS {
        let mut histogram = vec![0; 256];
        let mut left = random.random_range(0..=HITS);
        if list.len() % 2 == 0 {
            let (centre, sigma) =
                (random.random_range(20.0..200.0), random.random_range(1.0..20.0));
            let normal = Normal::new(centre, sigma).unwrap();
            for _ in 0..left {
                let ambient = random.random_bool(0.4);
                let bin = if ambient {
                    random.random_range(0.0..256.0)
                } else {
                    normal.sample(&mut random)
                };
                histogram[(bin as usize).min(255)] += 1;
            }
        } else {
            while left > 0 {
                let most = left >> random.random_range(0..12);
                let count = random.random_range(0..=most.max(1)).min(left);
                histogram[random.random_range(0..256)] += count;
                left -= count.max(1);
            }
        }
        list.push(histogram);
    }
    list
}

/// Depth words and edges of the clocked block.
fn stepped(params: &Params, histograms: &[Histogram]) -> Vec<(String, u64)> {
    let mut block = DepthEstimator::default();
    let mut edge = |algo_start, histogram: &Histogram| {
        let control = &block.estimator_ctrl;
        let word = if control.read_en { histogram[control.read_addr.index()] } else { 0 };
        block.rise(&In { rst: false, algo_start, count: U::new(word.into()) }, params);
        let done = block.estimator_ctrl.algo_done;
        done.then(|| format!("{:09x}", block.forward2.depth.bits()))
    };
    edge(false, &histograms[0]);
    let depth = |histogram| {
        let mut found = edge(true, histogram);
        let mut edges = 0;
        while found.is_none() {
            found = edge(false, histogram);
            edges += 1;
        }
        (found.unwrap(), edges)
    };
    histograms.iter().map(depth).collect()
}

/// An estimator in the bench, and what it shows beside depth and edges.
struct Dut {
    /// Name and parameters of the module.
    module: String,
    roms: Vec<Mem>,
    /// Wires and ports beside the socket's.
    wires: &'static str,
    ports: &'static str,
    /// Of a line of `$display`.
    shown: &'static str,
    values: &'static str,
}

/// Runs the Verilog, and returns a line for each histogram: depth, edges, and further outputs.
fn simulated(folder: &Path, dut: Dut, histograms: &[Histogram]) -> Vec<String> {
    let words = histograms.iter().flatten().map(|&count| count.into());
    fs::write(folder.join("histograms.mem"), lines(words, 4)).unwrap();
    for rom in dut.roms {
        fs::write(folder.join(&*rom.name), rom.text).unwrap();
    }
    let mut bench = BENCH.replace("HISTOGRAMS", &histograms.len().to_string());
    for (place, text) in [
        ("MODULE", &dut.module[..]),
        ("WIRES", dut.wires),
        ("PORTS", dut.ports),
        ("SHOWN", dut.shown),
        ("VALUES", dut.values),
    ] {
        bench = bench.replace(place, text);
    }
    let path = folder.join("bench.v");
    fs::write(&path, bench).unwrap();
    let rtl = Rtl::folder(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rtl_ref")).unwrap();
    let limits = Limits::new(Duration::from_secs(600));
    let simulator = Simulator::Verilator;
    let compiled = simulator.compile(folder, "bench", &[path], &rtl, false, &limits).unwrap();
    let finished = compiled.run(&[], &limits).unwrap();
    let found = finished.output.lines().filter_map(|line| line.strip_prefix("found "));
    found.map(|line| line.trim_end().to_owned()).collect()
}

/// The network.
fn network_of(params: &Params) -> Dut {
    let module = format!(
        "depth_estimator #(.Neurons(5'd{}), .W1File(\"w1.mem\"), .B1File(\"b1.mem\"), \
         .W2File(\"w2.mem\"), .B2File(\"b2.mem\"), .TansigFile(\"tansig.mem\"))",
        params.neurons()
    );
    let roms = mem::depth_estimator(params);
    Dut { module, roms, wires: "", ports: "", shown: "", values: "" }
}

/// Depth words of the program.
fn estimated(folder: &Path, network: &str, histograms: &[Histogram]) -> Vec<String> {
    let bytes: Vec<u8> =
        histograms.iter().flatten().flat_map(|&count| (count as u16).to_le_bytes()).collect();
    let mut shape = String::new();
    write!(shape, "({}, 256)", histograms.len()).unwrap();
    fs::write(folder.join("histograms.npy"), common::npy("<u2", &shape, &bytes)).unwrap();
    let report =
        common::json(folder, &["estimate", "histograms.npy", "--network", network, "--json"]);
    let rows = report["histograms"].as_array().unwrap();
    rows.iter().map(|row| row["depth_raw"].as_str().unwrap().to_owned()).collect()
}

fn agree(network: &str, edges: u64) {
    let histograms = histograms();
    assert_eq!(histograms.len(), HISTOGRAMS);
    let folder = common::empty();
    let params = Network::builtin(network).unwrap().unwrap().params(&Default::default());
    let stepped = stepped(&params, &histograms);
    assert!(stepped.iter().all(|(_, taken)| *taken == edges));
    let lines = simulated(folder.path(), network_of(&params), &histograms);
    let expected = stepped.iter().map(|(depth, edges)| format!("{depth} {edges}"));
    assert!(expected.eq(lines), "the Verilog differs");
    let words: Vec<_> = stepped.into_iter().map(|(depth, _)| depth).collect();
    assert!(words == estimated(folder.path(), network, &histograms), "estimate differs");
    let mut different = words.clone();
    different.sort_unstable();
    different.dedup();
    assert!(different.len() > HISTOGRAMS / 2, "only {} different depths", different.len());
}

#[test]
#[ignore = "long: ./check --full"]
fn eight_neurons_agree_on_10_000_histograms() {
    agree("uniform", 267);
}

#[test]
#[ignore = "long: ./check --full"]
fn sixteen_neurons_agree_on_10_000_histograms() {
    agree("uniform-16", 275);
}
