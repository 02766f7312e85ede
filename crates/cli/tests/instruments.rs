//! Instruments other than the KC705: drawn at random over what the firmware's parameters can be, each block
//! and the whole in Verilog, and every way through time.

mod built_in;
mod drawn;
mod files;

use std::sync::LazyLock;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::{Run, Stepping};

use crate::common::{empty, json, refused, setup};
use crate::fidelities::{LEVEL, counts, drawn_frames, shot_frames, two_sample};
use crate::lockstep::recorded::{Passed, verified_as};
use crate::record::Record;

use drawn::instrument;

/// Blocks that clocks, chain, laser, the size of the histogram or the network reach.
const BLOCKS: [&str; 20] = [
    "carry_chain",
    "centroid_estimator",
    "coarse_counter",
    "code_preload",
    "control_sync",
    "ddr_output",
    "depth_estimator",
    "estimator_ctrl",
    "forward1",
    "forward2",
    "frame_ctrl",
    "histogram_builder",
    "histogram_preload",
    "likelihood_estimator",
    "pll",
    "tansig",
    "tdc",
    "tdc_decoder",
    "tdc_latch",
    "vcsel_driver",
];
/// Clock cycles of each of them, enough to clear the largest histogram, and to fill and estimate it [cycles].
const FEW: [&str; 2] = ["--cycles", "6000"];

static INSTRUMENTS: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/instruments/instruments.record");
    Record::read(path, "cargo test -p tofsim-cli --test cli instruments -- --include-ignored")
});

/// Verifies blocks of the instrument of a seed in a simulator.
fn verified_of(seed: u64, simulator: &str, blocks: &[&str], options: &[&str]) -> Vec<Passed> {
    let (mut random, folder) = (ChaCha8Rng::seed_from_u64(seed), empty());
    let keys = instrument(&mut random, folder.path(), 40.0);
    let set: Vec<_> = keys.iter().flat_map(|key| ["-s", key]).collect();
    let options = [&set[..], options].concat();
    verified_as(&INSTRUMENTS, &format!("of instrument {seed}"), simulator, blocks, &options)
}

/// Verifies each block of an instrument alone for a few cycles, and a frame with the registers of all blocks.
fn passes_in_icarus(seed: u64) {
    verified_of(seed, "icarus", &BLOCKS, &FEW);
    verified_of(seed, "icarus", &["tof_top"], &[]);
}

/// Instruments of the long test in Icarus; more make it longer.
fn instruments() -> u64 {
    let configured = std::env::var("TOFSIM_INSTRUMENTS").ok();
    configured.map_or(10, |count| count.parse().expect("TOFSIM_INSTRUMENTS is a whole number"))
}

#[test]
fn an_instrument_passes_in_icarus() {
    passes_in_icarus(0);
}

#[test]
#[ignore = "long: ./check --full"]
fn many_instruments_pass_in_icarus() {
    (1..1 + instruments()).into_par_iter().for_each(passes_in_icarus);
}

#[test]
#[ignore = "long: ./check --full"]
fn twice_as_many_instruments_pass_in_verilator() {
    // A program for each block costs minutes; a frame reaches all of them.
    for seed in 12..12 + instruments().div_ceil(3) {
        for (block, passed) in BLOCKS.iter().zip(verified_of(seed, "verilator", &BLOCKS, &[])) {
            let (met, of) = passed.goals;
            // A draw may leave out rare cases: entries of a large table, and limits. Counts of many bits, which instruments
            // after the first have, are drawn in steps whose spread fits no pulse, so that every depth has a status.
            let least = match (["likelihood_estimator", "tansig"].contains(block), seed) {
                (false, _) => 9,
                (true, 12) => 8,
                (true, _) => 7,
            };
            assert!(met * 10 >= of * least, "{block} of instrument {seed}: {passed:?}");
        }
    }
    (12..12 + 2 * instruments()).into_par_iter().for_each(|seed| {
        verified_of(seed, "verilator", &["tof_top"], &[]);
    });
}

#[test]
fn every_way_through_time_gives_the_same_frames() {
    let mut hits = 0;
    for seed in 0..32 {
        let (mut random, folder) = (ChaCha8Rng::seed_from_u64(seed), empty());
        let mut keys = instrument(&mut random, folder.path(), 300.0);
        keys.push("firmware.shots_per_frame=200".to_owned());
        let set: Vec<_> = keys.iter().map(String::as_str).collect();
        let setup = setup("bright", &set);
        let frames = |stepping| -> Vec<String> {
            let frames = Run::new(&setup).stepping(stepping).frames(3).unwrap();
            frames.iter().map(|frame| format!("{frame:?}")).collect()
        };
        let stepped = frames(Stepping::EveryCycle);
        for stepping in [Stepping::SkipIdle, Stepping::LeapShots] {
            assert_eq!(frames(stepping), stepped, "seed {seed}: {keys:?}");
        }
        hits += Run::new(&setup).frames(1).unwrap()[0].hits();
    }
    assert!(hits > 1_000, "{hits}");
}

/// Of those whose shots are independent; the others are refused with the reason.
#[test]
fn histograms_drawn_at_once_are_distributed_as_those_of_the_instruments_shots() {
    let (mut compared, instruments) = (0, 60);
    for seed in 0..instruments {
        let (mut random, folder) = (ChaCha8Rng::seed_from_u64(seed), empty());
        let mut keys = instrument(&mut random, folder.path(), 300.0);
        keys.push(format!("spad.on_tdc={}", [1, 3, 40][random.random_range(0..3)]));
        let set: Vec<_> = keys.iter().map(String::as_str).collect();
        let setup = setup("bright", &set);
        if Histograms::new(&setup).is_err() {
            continue;
        }
        let [shot, drawn] = [shot_frames(&setup, 8), drawn_frames(&setup, 8)];
        for (shot, drawn) in shot.iter().zip(&drawn) {
            assert_eq!(shot.frame_cycles, drawn.frame_cycles, "seed {seed}: {keys:?}");
            assert_eq!(shot.estimator_cycles, drawn.estimator_cycles);
        }
        let chance = two_sample(&counts(&shot), &counts(&drawn));
        assert!(chance > LEVEL / instruments as f64, "seed {seed}, {chance}: {keys:?}");
        compared += 1;
    }
    assert!(compared >= 30, "{compared}");
}

#[test]
#[ignore = "long: ./check --full"]
fn a_network_for_other_bins_is_trained_estimates_and_is_measured() {
    let folder = empty();
    let keys = ["-s", "tdc.bins=64", "-s", "tdc.bin_ps=100", "-s", "firmware.count_bits=18"];
    let run = |arguments: &[&str]| json(folder.path(), &[arguments, &keys].concat());
    run(&["train", "--quick", "--json", "-o", "net"]);
    let network = folder.path().join("net/network.toml");
    let own = format!("estimator.network={}", network.display());
    let frame = run(&["run", "--waves", "none", "--json", "-o", "out", "-s", &own]);
    assert_eq!(frame["frames"][0]["estimator_cycles"], 75);
    assert_eq!(frame["frames"][0]["histogram"].as_array().unwrap().len(), 64);
    let depth_m = frame["frames"][0]["depth_m"].as_f64().unwrap();
    assert!((depth_m - 0.5).abs() < 0.03, "{depth_m}");
    let name = network.to_str().unwrap();
    let estimate = run(&["estimate", "out/histogram.csv", "--network", name, "--json"]);
    assert_eq!(estimate["depth_raw"], frame["frames"][0]["depth_raw"]);
    run(&["dataset", "--rows", "1020", "--format", "parquet,npy", "--json", "-o", "data"]);
    for data in ["data", "data/dataset.parquet"] {
        let found =
            run(&["evaluate", "--data", data, name, "--estimator", "network,matched", "--json"]);
        for estimator in found["estimators"].as_array().unwrap() {
            let two_sd_mm = estimator["all"]["two_sd_mm"].as_f64().unwrap();
            assert!(two_sd_mm < 40.0, "{data}: {estimator}");
        }
    }
    let wide = run(&["dataset", "--rows", "510", "--format", "npy", "--json", "-o", "wide"]);
    assert_eq!(wide["rows"], 510);
    let bytes = std::fs::read(folder.path().join("wide/histograms.npy")).unwrap();
    assert!(String::from_utf8_lossy(&bytes[..128]).contains("'<u4'"), "more than 16 bits");
}

#[test]
fn what_does_not_fit_is_refused_with_what_would() {
    let folder = empty();
    let chain = |text: &str| {
        std::fs::write(folder.path().join("chain.toml"), text).unwrap();
        refused(folder.path(), &["run", "--waves", "none", "-s", "tdc.profile=./chain.toml"])
    };
    let key = |keys: &[&str]| {
        let set = keys.iter().flat_map(|key| ["-s", key]);
        refused(
            folder.path(),
            &["run", "--waves", "none"].into_iter().chain(set).collect::<Vec<_>>(),
        )
    };
    for (found, expected) in [
        (
            key(&["firmware.laser_periods=[25, 3]"]),
            "firmware.laser_periods.1 = 3: expected a whole number from 4",
        ),
        (key(&["firmware.laser_periods=[]"]), "expected a list of 1 to 8"),
        (key(&["firmware.laser_periods=[9, 9, 9, 9, 9, 9, 9, 9, 9]"]), "expected a list of 1 to 8"),
        (key(&["firmware.laser_periods=[70000]"]), "from 4 to 65535"),
        (key(&["firmware.laser_periods=[10, 20]"]), "firmware.laser_freq = 3: expected 1 at most"),
        (key(&["firmware.laser_freq=4"]), "expected 3 at most, the last of firmware.laser_periods"),
        (
            key(&["control=[{at_us=3, laser_freq=5}]"]),
            "control.0.laser_freq = 5: expected 3 at most",
        ),
        (key(&["firmware.pulse_half_cycles=9"]), "from 1 to 8 [half cycles of clk_laser]"),
        (
            key(&["firmware.drain_cycles=9"]),
            "firmware.drain_cycles = 9: expected 10 cycles or more",
        ),
        (key(&["tdc.bins=300"]), "tdc.bins = 300: expected a power of two, such as 256 or 512"),
        (key(&["tdc.bins=8"]), "from 16 to 1024 [bins]"),
        (key(&["tdc.bins=64"]), "estimator.network = uniform: it has 256 inputs, expected 64"),
        (key(&["firmware.count_bits=25"]), "from 8 to 24 [bit]"),
        (
            key(&["firmware.count_bits=12"]),
            "firmware.shots_per_frame = 30000: expected 4095 at most, what a word of 12 bits holds \
             (firmware.count_bits; 15 would do)",
        ),
        (key(&["tdc.bin_ps=4.9"]), "from 5.0 to 2000.0 [ps]"),
        (
            key(&["tdc.bin_ps=2000", "tdc.first_bin_ps=62001"]),
            "tdc.first_bin_ps = 62001: expected 62000 ps at most, a bin less than the window that 3 bits count",
        ),
        (key(&["tdc.bin_ps=200"]), "firmware.laser_periods.2 = 8: expected 9 cycles or more"),
        (key(&["tdc.coarse_bits=13"]), "from 1 to 12 [bit]"),
        (key(&["tdc.coarse_bits=0"]), "from 1 to 12 [bit]"),
        (chain("offset_ps = 2230\ntap_ps = 11.5\ntaps = 15"), "from 16 to 2000"),
        (chain("offset_ps = 2230\ntap_ps = 11.5\ntaps = 400"), "the 400 taps take 4600 ps"),
        (chain("offset_ps = 2230\ntap_ps = 11.5\ntaps = 2000"), "16 ns at most"),
        (
            chain(
                "offset_ps = 2230\ntaps = 17\ntap_delays_ps = [600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600]",
            ),
            "taps = 17: expected 16, as many as tap_delays_ps has",
        ),
        (
            chain("offset_ps = 2230\ntap_ps = 11.5\n[[extra]]\ntap = 800\nps = 3"),
            "extra.0.tap = 800: expected 799 at most",
        ),
    ] {
        assert!(found.contains(expected), "{found}\n{expected}");
    }
}
