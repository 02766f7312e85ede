//! Instruments drawn at random over what the firmware's parameters can be.

use std::path::Path;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::kernel::{Overflow, WordFormat};
use tofsim::network::Network;
use tofsim::network::file::Training;
use tofsim::network::float::Float;
use tofsim::network::unrounded::Unrounded;

/// Part, oscillator [MHz], M, D and O, from 50 to 200 MHz of clk_sys.
const CLOCKS: [(&str, u64, u64, u64, u64); 10] = [
    ("kintex7", 200, 5, 1, 8),
    ("kintex7", 200, 5, 1, 10),
    ("kintex7", 200, 8, 1, 8),
    ("kintex7", 100, 9, 1, 8),
    ("kintex7", 150, 13, 2, 14),
    ("kintex7", 33, 37, 1, 16),
    ("ecp5", 25, 24, 1, 6),
    ("ecp5", 200, 5, 2, 10),
    ("ecp5", 12, 63, 1, 6),
    ("ecp5", 33, 21, 1, 6),
];

/// A number from `low` to `high`, small ones as often as large ones.
fn log_uniform(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    (random.random_range(low.ln()..=high.ln())).exp()
}

/// Any number formats that can be built, a table of few entries as often as a large one.
fn datapath(random: &mut ChaCha8Rng) -> Datapath {
    loop {
        let mut word = || WordFormat {
            width: random.random_range(2..=24),
            fraction: random.random_range(0..=32),
        };
        let (w1, b1, w2, b2, l1_out) = (word(), word(), word(), word(), word());
        let (address_bits, range_log2) = (random.random_range(4..=16), random.random_range(0..=6));
        let any = Datapath { w1, b1, w2, b2, l1_out, address_bits, range_log2 };
        if any.fault().is_none() {
            return any;
        }
    }
}

/// The file of a network of random weights, of any size and formats, for so many bins.
fn network(random: &mut ChaCha8Rng, bins: usize, path: &Path) {
    let neurons = random.random_range(1..=32);
    let datapath = if random.random() { datapath(random) } else { Datapath::THESIS };
    network_of(random, (bins, neurons), datapath, path);
}

/// The same for so many bins and of so many neurons, of these formats.
pub fn network_of(
    random: &mut ChaCha8Rng,
    (bins, neurons): (usize, usize),
    datapath: Datapath,
    path: &Path,
) {
    let mut weights = |count: usize, format: WordFormat| -> Vec<f64> {
        let most = 0.99 * format.range();
        (0..count).map(|_| random.random_range(-most..most)).collect()
    };
    let w1 = (0..neurons).map(|_| weights(bins, datapath.w1)).collect();
    let (b1, w2) = (weights(neurons, datapath.b1), weights(neurons, datapath.w2));
    let float = Float { w1, b1, w2, b2: weights(1, datapath.b2)[0] };
    let network = Network {
        name: String::new(),
        description: "random weights".to_owned(),
        training: Training::default(),
        domain: None,
        accuracy: None,
        datapath,
        fixed: float.round("random", &datapath, Overflow::Saturate).unwrap().fixed,
        float: Unrounded::Unknown,
    };
    std::fs::write(path, network.to_toml()).unwrap();
}

/// The keys of an instrument, with a chain and a network of its own in the folder.
pub fn instrument(random: &mut ChaCha8Rng, folder: &Path, longest_period: f64) -> Vec<String> {
    let (part, input_mhz, multiply, divide, output_divide) =
        CLOCKS[random.random_range(0..CLOCKS.len())];
    let cycle_ps = 1e6 * (divide * output_divide) as f64 / (input_mhz * multiply) as f64;
    let taps = log_uniform(random, 16.0, 2000.0).round();
    let offset_ps = random.random_range(300.0..0.87 * cycle_ps);
    let tap_ps = random.random_range(1.04 * cycle_ps..1.99 * cycle_ps - offset_ps) / taps;
    let uneven = random.random_range(0.0..0.9);
    let mut delays = Vec::new();
    while (delays.len() as f64) < taps {
        delays
            .push((tap_ps * (1.0 + uneven * random.random_range(-1.0..1.0)) * 10.0).round() / 10.0);
    }
    let span: f64 = delays.iter().sum();
    let stretch = tap_ps * taps / span;
    delays.iter_mut().for_each(|delay| *delay = (*delay * stretch * 1000.0).round() / 1000.0);
    let chain = folder.join("chain.toml");
    std::fs::write(&chain, format!("offset_ps = {offset_ps:?}\ntap_delays_ps = {delays:?}\n"))
        .unwrap();
    let coarse_bits = random.random_range(1..=12);
    let bin_ps = (log_uniform(random, 5.0, 800.0) * 1e3).round() / 1e3;
    let most_first_ps = (cycle_ps * f64::from(1 << coarse_bits) - bin_ps).min(60_000.0);
    let first_ps =
        [0.0, random.random_range(0.0..most_first_ps).round()][random.random_range(0..2)];
    let bins = 1u32 << random.random_range(4..=10);
    let count_bits = random.random_range(9..=24);
    network(random, bins as usize, &folder.join("network.toml"));
    // An edge that no code is later than.
    let last = ((f64::from(bins) * bin_ps + first_ps) / cycle_ps).ceil() as u64 + 2;
    let last = last.min(1 << coarse_bits);
    let rates = random.random_range(1..=8);
    let shortest = (last + 2).max(5);
    let period =
        |_| log_uniform(random, shortest as f64, shortest as f64 + longest_period).round() as u64;
    let periods: Vec<_> = (0..rates).map(period).collect();
    // An event for each tap: Icarus takes minutes for the longest chains.
    let decoders = match taps <= 400.0 {
        true => &["ones", "leading", "reordered"][..],
        false => &["ones", "leading"],
    };
    vec![
        format!("pll.part={part}"),
        format!("pll.input_hz={}", input_mhz * 1_000_000),
        format!("pll.multiply={multiply}"),
        format!("pll.divide={divide}"),
        format!("pll.output_divide={output_divide}"),
        format!("tdc.profile={}", chain.display()),
        format!("tdc.coarse_bits={coarse_bits}"),
        format!("tdc.bins={bins}"),
        format!("firmware.count_bits={count_bits}"),
        "firmware.shots_per_frame=400".to_owned(),
        format!("estimator.network={}", folder.join("network.toml").display()),
        format!("estimator.kind={}", ["network", "centroid"][random.random_range(0..2)]),
        format!("estimator.centroid_half_width={}", random.random_range(1..=31)),
        format!("tdc.bin_ps={bin_ps}"),
        format!("tdc.first_bin_ps={first_ps}"),
        format!("tdc.count_stages={}", random.random_range(2..=3)),
        format!("tdc.decoder={}", decoders[random.random_range(0..decoders.len())]),
        format!("firmware.laser_periods={periods:?}"),
        format!("firmware.laser_freq={}", random.random_range(0..rates)),
        format!("firmware.pulse_half_cycles={}", random.random_range(1..=8)),
        format!("firmware.drain_cycles={}", random.random_range(last + 8..last + 100)),
        format!("firmware.mode={}", random.random_range(0..2)),
        format!("seed={}", random.random_range(0..u32::MAX)),
        format!("laser.delay_ps={}", [0, 650][coarse_bits as usize % 2]),
    ]
}
