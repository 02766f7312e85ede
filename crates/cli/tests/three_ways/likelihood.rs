//! Ten thousand histograms, random and extreme, through the Verilog of the likelihood estimator and through the
//! integers without a clock: the same depth, deviation, status and chi-square to the bit.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Hazard};
use tofsim::sim::estimates::likelihood::estimate;
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::parameters::{self, Parameter};

use super::{Dut, HISTOGRAMS, HITS, simulated};
use crate::common;

/// Scenes that half of the histograms are drawn of.
const SCENES: usize = 250;

/// Those of the network's test, then words that no frame could hold, then frames of scenes.
fn histograms() -> Vec<Histogram> {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut list = super::histograms();
    list.truncate(HISTOGRAMS / 4);
    let of = |word: &mut dyn FnMut(usize) -> u32| (0..256).map(word).collect::<Histogram>();
    list.push(of(&mut |_| HITS));
    list.extend([0, 1].map(|odd| of(&mut |bin| if bin % 2 == odd { HITS } else { 0 })));
    // So many shots are left for an echo of all of them, about as many as it has to have.
    for left in 1..=64 {
        let echo = |bin: usize| (left + (bin as u32 * 7) % 8) / 8;
        list.push(of(&mut |bin| match bin {
            0 => 30_000 - left,
            100..108 => echo(bin - 100),
            _ => 0,
        }));
    }
    // Echoes that hardly stand out.
    for _ in 0..1_000 {
        let (place, level) = (random.random_range(20..236), random.random_range(1..60));
        let high = random.random_range(5.0..7.0) * f64::from(level * 15).sqrt() / 15.0;
        let noise = level / 4 + 1;
        list.push(of(&mut |bin| {
            let echo = if bin.abs_diff(place) < 8 { high.round() as u32 } else { 0 };
            level + echo + random.random_range(0..noise)
        }));
    }
    while list.len() < HISTOGRAMS / 2 {
        let (place, level) = (random.random_range(0..256), random.random_range(0..300));
        let high = random.random_range(0..=HITS);
        list.extend([
            of(&mut |bin| if bin == 0 { high } else { 0 }),
            of(&mut |bin| if bin == place { high } else { level }),
            of(&mut |bin| if bin < place { level } else { 0 }),
            of(&mut |bin| if bin >= place { high } else { 1 }),
            of(&mut |bin| if bin.abs_diff(place) < 5 { high / 64 } else { level % 5 }),
            of(&mut |_| random.random_range(0..=HITS)),
            of(&mut |_| random.random_range(0..=level)),
        ]);
    }
    list.truncate(HISTOGRAMS / 2);
    for _ in 0..SCENES {
        let mut between = |key, from: f64, to| format!("{key}={}", random.random_range(from..to));
        let scene = [
            between("target.distance_m", 0.04, 0.85),
            between("target.reflectance", 0.02, 0.95),
            between("ambient.irradiance_w_m2_nm", 0.0, 1.0),
        ];
        let setup = Setup::load("kc705", &scene.each_ref().map(String::as_str)).unwrap();
        let chances = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
        for _ in 0..HISTOGRAMS / 2 / SCENES {
            let drawn = chances.draw(30_000, &mut random);
            list.push(drawn.into_iter().map(|count| count as u32).collect());
        }
    }
    list
}

/// The estimator of such parameters.
fn likelihood_of(params: &Params) -> Dut {
    let (mut set, mut roms) = (Vec::new(), Vec::new());
    for (name, value) in parameters::likelihood_estimator(params) {
        set.push(format!(".{name}({})", value.literal()));
        if let Parameter::Memory(rom) = value {
            roms.push(rom);
        }
    }
    Dut {
        module: format!("likelihood_estimator #({})", set.join(", ")),
        roms,
        wires: "wire valid; wire [35:0] sigma; wire [6:0] status; wire [32:0] chi_square;",
        ports: ".mode(1'b0), .sigma(sigma), .status(status), .chi_square(chi_square), .valid(valid),",
        shown: "%h %h %h %b",
        values: ", sigma, status, chi_square, valid",
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn the_likelihood_estimator_s_verilog_finds_the_integers_in_10_000_histograms() {
    let histograms = histograms();
    assert_eq!(histograms.len(), HISTOGRAMS);
    let (folder, setup) = (common::empty(), Setup::load("kc705", &[]).unwrap());
    let params = setup.likelihood(30_000).unwrap();
    let lines = simulated(folder.path(), likelihood_of(&params), &histograms);
    assert_eq!(lines.len(), HISTOGRAMS);
    let mut statuses = [0; 64];
    for (k, (histogram, line)) in histograms.iter().zip(&lines).enumerate() {
        let found = estimate(&params, histogram);
        let (depth, status) = (found.words().depth.bits(), found.status.bits());
        let expected = format!(
            "{depth:09x} {} {:09x} {status:02x} {:09x} {:b}",
            params.done(),
            found.sigma,
            found.chi_square,
            u8::from(status == 0)
        );
        assert_eq!(line, &expected, "histogram {k}: {histogram:?}");
        statuses[usize::from(status)] += 1;
    }
    let with = |bit: u16| -> usize {
        let all = statuses.iter().enumerate();
        all.filter(|(status, _)| status & usize::from(bit) != 0).map(|(_, count)| count).sum()
    };
    let seen = [1, 2, 4, 8, 16, 32].map(with);
    assert!(statuses[0] > HISTOGRAMS / 4, "{statuses:?}");
    assert!(seen.iter().all(|&count| count > 20), "bits of the status are seldom set: {seen:?}");
}
