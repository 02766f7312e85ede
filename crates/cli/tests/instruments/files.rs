//! Instrument files with one thing wrong each: refused with the place, the value and what would do.

use std::fs;
use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use tofsim::firmware::depth_estimator::datapath::Datapath;

use crate::common::{empty, refused, stdout};

use super::drawn::network_of;

/// A small instrument of its own clock, chain, histogram and network.
const SCENARIO: &str = r#"
[pll]
part = "kintex7"
input_hz = 200000000
multiply = 5
divide = 1
output_divide = 8
[tdc]
profile = "./chain.toml"
bins = 64
bin_ps = 100.0
first_bin_ps = 0.0
coarse_bits = 3
count_stages = 3
[firmware]
laser_periods = [25, 13]
laser_freq = 1
pulse_half_cycles = 1
drain_cycles = 16
count_bits = 9
shots_per_frame = 300
[estimator]
network = "network.toml"
"#;
const CHAIN: &str = "offset_ps = 2230\ntap_ps = 40.0\ntaps = 220\n";

/// A line of the scenario, what stands there instead, and what the message says.
const OF_SCENARIO: [(&str, &str, &str); 29] = [
    ("part = \"kintex7\"", "part = \"kintex8\"", "kintex8"),
    ("input_hz = 200000000", "input_hz = 2000000000", "pll.input_hz = 2000000000: expected"),
    ("multiply = 5", "multiply = 2", "pll.multiply = 2: the VCO would run at 400 MHz"),
    ("multiply = 5", "multiply = 60", "pll.multiply = 60: the VCO would run at 12000 MHz"),
    (
        "divide = 1\n",
        "divide = 20\n",
        "the VCO would run at 50 MHz, expected 800 to 1866 MHz for a PLLE2; pll.divide = 1 fits",
    ),
    ("output_divide = 8", "output_divide = 129", "pll.output_divide = 129: expected"),
    ("output_divide = 8", "output_divide = 12", "12 ns or more, a period"),
    ("profile = \"./chain.toml\"", "profile = \"./chian.toml\"", "chian.toml"),
    ("bins = 64", "bins = 300", "tdc.bins = 300: expected a power of two, such as 256 or 512"),
    ("bins = 64", "bins = 8", "tdc.bins = 8: expected a whole number from 16 to 1024"),
    ("bins = 64", "bins = 128", "it has 64 inputs, expected 128"),
    ("bin_ps = 100.0", "bin_ps = 4.0", "tdc.bin_ps = 4.0: expected a number from 5.0 to 2000.0"),
    ("bin_ps = 100.0", "bin_ps = \"wide\"", "tdc.bin_ps = \"wide\": expected a number"),
    (
        "first_bin_ps = 0.0\ncoarse_bits = 3",
        "first_bin_ps = 0.0\ncoarse_bits = 0",
        "tdc.coarse_bits = 0: expected a whole number from 1 to 12",
    ),
    (
        "first_bin_ps = 0.0",
        "first_bin_ps = 63901",
        "tdc.first_bin_ps = 63901: expected 63900 ps at most",
    ),
    ("first_bin_ps = 0.0", "first_bin_ps = -1.0", "tdc.first_bin_ps = -1.0: expected"),
    ("count_stages = 3", "decoder = \"leeding\"", "leeding"),
    ("count_stages = 3", "count_stages = 4", "tdc.count_stages = 4: expected"),
    ("[25, 13]", "[25, 3]", "firmware.laser_periods.1 = 3: expected a whole number from 4"),
    ("[25, 13]", "[]", "firmware.laser_periods = []: expected a list of 1 to 8"),
    ("[25, 13]", "[25, 70000]", "firmware.laser_periods.1 = 70000: expected"),
    ("[25, 13]", "[25, 13.5]", "firmware.laser_periods.1 = 13.5: expected a whole number"),
    ("laser_freq = 1", "laser_freq = 2", "firmware.laser_freq = 2: expected 1 at most"),
    ("pulse_half_cycles = 1", "pulse_half_cycles = 9", "firmware.pulse_half_cycles = 9: expected"),
    ("drain_cycles = 16", "drain_cycles = 8", "firmware.drain_cycles = 8: expected"),
    ("count_bits = 9", "count_bits = 7", "firmware.count_bits = 7: expected"),
    (
        "count_bits = 9",
        "count_bits = 8",
        "firmware.shots_per_frame = 300: expected 255 at most, what a word of 8 bits holds \
         (firmware.count_bits; 9 would do)",
    ),
    ("shots_per_frame = 300", "shots_per_frame = 0", "firmware.shots_per_frame = 0: expected"),
    ("network = \"network.toml\"", "network = \"netwrok.toml\"", "netwrok.toml: no such file"),
];

/// The same of the chain's file.
const OF_CHAIN: [(&str, &str, &str); 5] = [
    ("taps = 220", "taps = 15", "taps = 15: expected a whole number from 16 to 2000"),
    ("taps = 220", "taps = 100", "the 100 taps take 4000 ps"),
    ("taps = 220", "taps = 1000", "expected"),
    ("tap_ps = 40.0", "tap_ps = -40.0", "tap_ps = -40.0: expected"),
    ("offset_ps = 2230", "ofset_ps = 2230", "did you mean `offset_ps`?"),
];

/// The same of the network's file.
const OF_NETWORK: [(&str, &str, &str); 7] = [
    ("w2 = [", "w3 = [", "integers.w2: missing; expected a list"),
    ("w2 = [\n", "w2 = [\n    1,\n", "expected 4, one a neuron"),
    ("w1 = [\n", "w1 = []\nold = [\n", "integers.w1 = []: expected a list of 1 to 32"),
    (
        "b1 = { width = 16",
        "b1 = { width = 25",
        "formats.b1.width = 25: expected a width of 2 to 24",
    ),
    ("w2 = { width = 16", "w2 = { width = 2", "integers.w2.0 = "),
    (
        "address_bits = 12",
        "address_bits = 17",
        "formats.tansig.address_bits = 17: expected 4 to 16",
    ),
    ("range = 4", "range = 3", "formats.tansig.range = 3: expected 1, 2, 4"),
];

/// Writes the files into a folder, one of them changed.
fn write(folder: &Path, network: &str, changed: &str, from: &str, to: &str) {
    for (name, text) in [("a.toml", SCENARIO), ("chain.toml", CHAIN), ("network.toml", network)] {
        let text = match name == changed {
            true if text.contains(from) => text.replacen(from, to, 1),
            true => panic!("{changed} has no {from}"),
            false => text.to_owned(),
        };
        fs::write(folder.join(name), text).unwrap();
    }
}

#[test]
fn forty_files_with_one_thing_wrong_each_are_refused_with_the_place_and_what_would_do() {
    let (folder, mut random) = (empty(), ChaCha8Rng::seed_from_u64(3));
    let path = folder.path();
    network_of(&mut random, (64, 4), Datapath::THESIS, &path.join("network.toml"));
    let network = fs::read_to_string(path.join("network.toml")).unwrap();
    write(path, &network, "", "", "");
    let run = ["run", "a.toml", "--waves", "none", "-o", "out"];
    stdout(path, &run);
    fs::remove_dir_all(path.join("out")).unwrap();
    let files =
        [("a.toml", &OF_SCENARIO[..]), ("chain.toml", &OF_CHAIN), ("network.toml", &OF_NETWORK)];
    let mut others = Vec::new();
    for (file, faults) in files {
        for (from, to, expected) in faults {
            write(path, &network, file, from, to);
            let found = refused(path, &run);
            if !found.contains(expected) || path.join("out").exists() {
                others.push(format!("{to}: {found}{expected}"));
            }
        }
    }
    assert!(others.is_empty(), "message and expected:\n{}", others.join("\n\n"));
}
