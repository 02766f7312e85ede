//! The fidelities beside `cycle`: the same frames from `shot`, the same distribution from
//! `histogram`, and a refusal by name of what they cannot show.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Run, Stepping};

use crate::common::{json, refused, setup, stdout};

/// Counts by outcome: every code, hits without one, no hit.
pub type Counts = Vec<u64>;

pub fn counts(frames: &[Frame]) -> Counts {
    let bins = frames[0].histogram.len();
    let mut counts = vec![0; bins + 2];
    for frame in frames {
        for (sum, &count) in counts.iter_mut().zip(&frame.histogram) {
            *sum += u64::from(count);
        }
        counts[bins] += frame.tdc_hits - frame.hits();
        counts[bins + 1] += frame.shots - frame.tdc_hits;
    }
    counts
}

pub fn shot_frames(setup: &Setup, count: u64) -> Vec<Frame> {
    Run::new(setup).stepping(Stepping::LeapShots).frames(count).unwrap()
}

pub fn drawn_frames(setup: &Setup, count: u64) -> Vec<Frame> {
    let histograms = Histograms::new(setup).unwrap();
    (0..count).map(|index| histograms.frame(index)).collect()
}

/// Chance of a chi-square as large or larger between two samples of the same size. Neighbouring
/// outcomes are taken together until 20 are expected in each sample.
pub fn two_sample(a: &Counts, b: &Counts) -> f64 {
    let (mut chi_square, mut cells, mut sums) = (0.0, 0.0, (0.0, 0.0));
    for (&a, &b) in a.iter().zip(b) {
        sums = (sums.0 + a as f64, sums.1 + b as f64);
        if sums.0 + sums.1 >= 40.0 {
            chi_square += (sums.0 - sums.1).powi(2) / (sums.0 + sums.1);
            (cells, sums) = (cells + 1.0, (0.0, 0.0));
        }
    }
    // What is left over joins nothing; both samples have the same total.
    if cells < 2.0 { 1.0 } else { 1.0 - ChiSquared::new(cells - 1.0).unwrap().cdf(chi_square) }
}

fn random_setup(random: &mut ChaCha8Rng) -> Setup {
    let chain = ["uniform", "table6_3", "ideal", "kintex7"][random.random_range(0..4)];
    let keys = [
        format!("target.distance_m={}", random.random_range(0.05..1.2)),
        format!("target.reflectance={}", random.random_range(0.02..0.9)),
        format!("ambient.irradiance_w_m2_nm={}", random.random_range(0.0..0.6)),
        format!("laser.pulse_sigma_ps={}", random.random_range(20.0..600.0)),
        format!("spad.on_tdc={}", [1, 1, 2, 40][random.random_range(0..4)]),
        format!("spad.dark_rate_hz={}", [0.0, 100.0, 1e7][random.random_range(0..3)]),
        format!("firmware.laser_freq={}", random.random_range(0..4)),
        format!("firmware.laser_en={}", random.random_bool(0.9)),
        format!("tdc.profile={chain}"),
        format!("seed={}", random.random_range(0..u32::MAX)),
        format!("pll.input_hz={}000000", [200, 180, 230, 260][random.random_range(0..4)]),
    ];
    setup("kc705", &keys.each_ref().map(String::as_str))
}

/// Level of each test below: a fault of chance once in 1,000 runs of this file, whose seeds are fixed.
pub const LEVEL: f64 = 1e-3;

#[test]
fn histograms_drawn_at_once_are_distributed_as_those_of_single_shots() {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let scenarios = 500;
    let mut chances: Vec<f64> = Vec::new();
    for _ in 0..scenarios {
        let setup = random_setup(&mut random);
        let [shot, drawn] = [shot_frames(&setup, 2), drawn_frames(&setup, 2)];
        for (shot, drawn) in shot.iter().zip(&drawn) {
            assert_eq!(shot.shots, drawn.shots);
            assert_eq!(shot.frame_cycles, drawn.frame_cycles);
            assert_eq!(shot.estimator_cycles, drawn.estimator_cycles);
        }
        chances.push(two_sample(&counts(&shot), &counts(&drawn)));
    }
    let worst = chances.iter().copied().fold(1.0, f64::min);
    assert!(worst > LEVEL / f64::from(scenarios), "{worst} at worst");
    // The chances of an exact draw are uniform: none too many low ones, and none too many high ones.
    chances.sort_by(f64::total_cmp);
    let steps = chances.iter().enumerate().map(|(k, chance)| {
        let below = k as f64 / chances.len() as f64;
        (chance - below).abs().max((chance - below - 1.0 / chances.len() as f64).abs())
    });
    let distance = steps.fold(0.0, f64::max);
    // Kolmogorov's limit at a level of 1e-3.
    assert!(distance < 1.95 / f64::from(scenarios).sqrt(), "{distance}");
}

/// With few shots a frame the last one counts: no reset of the SPAD ends it.
#[test]
fn hits_without_a_code_are_distributed_as_those_of_single_shots() {
    let setup = setup(
        "kc705",
        &[
            "firmware.shots_per_frame=2",
            "ambient.irradiance_w_m2_nm=0.02",
            "target.reflectance=0.01",
        ],
    );
    let frames = 60_000;
    let of = |frames: &[Frame]| {
        let mut hits = vec![0; 3];
        frames.iter().for_each(|frame| hits[(frame.tdc_hits - frame.hits()) as usize] += 1);
        hits
    };
    let [shot, drawn] = [of(&shot_frames(&setup, frames)), of(&drawn_frames(&setup, frames))];
    let chance = two_sample(&shot, &drawn);
    assert!(chance > LEVEL, "{shot:?} and {drawn:?}: {chance}");
}

#[test]
fn every_bin_has_the_mean_and_the_spread_of_single_shots() {
    let setup = setup("kc705", &["firmware.shots_per_frame=4000"]);
    let (frames, codes) = (300, 60..200);
    let [shot, drawn] = [shot_frames(&setup, frames), drawn_frames(&setup, frames)];
    let limit = Normal::standard().inverse_cdf(1.0 - LEVEL / 2.0 / (2.0 * codes.len() as f64));
    for code in codes {
        let moments = |frames: &[Frame]| {
            let values: Vec<_> = frames.iter().map(|f| f64::from(f.histogram[code])).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
            (mean, square / (values.len() - 1) as f64)
        };
        let ((mean_a, variance_a), (mean_b, variance_b)) = (moments(&shot), moments(&drawn));
        let n = frames as f64;
        let z = (mean_a - mean_b) / ((variance_a + variance_b) / n).sqrt();
        assert!(z.abs() < limit, "code {code}: means {mean_a} and {mean_b}");
        // The logarithm of a variance of n normal values has a variance of 2 / (n - 1), and a little
        // more for small counts.
        let kurtosis = 1.0 / mean_a;
        let log_ratio = (variance_a / variance_b).ln();
        let z = log_ratio / (2.0 * (2.0 / (n - 1.0) + kurtosis / n)).sqrt();
        assert!(z.abs() < limit, "code {code}: variances {variance_a} and {variance_b}");
    }
}

#[test]
fn shot_prints_what_cycle_prints_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    for keys in
        [["firmware.laser_freq=0", "firmware.mode=0"], ["firmware.laser_freq=3", "firmware.mode=1"]]
    {
        let run = |more: &[&str]| {
            let fixed = [
                "run",
                "--json",
                "--waves",
                "none",
                "--frames",
                "5",
                "-s",
                keys[0],
                "-s",
                keys[1],
                "-s",
                "firmware.shots_per_frame=700",
            ];
            stdout(folder.path(), &[&fixed, more].concat())
        };
        let cycle = run(&["--threads", "1"]);
        let named = |fidelity: &str| format!("\"fidelity\":\"{fidelity}\"");
        assert!(cycle.contains(&named("cycle")));
        for threads in ["1", "2", "3"] {
            assert_eq!(run(&["--threads", threads]), cycle, "{threads} threads");
            let shot = run(&["--threads", threads, "--fidelity", "shot"]);
            let shot = shot.replace(&named("shot"), &named("cycle"));
            assert_eq!(shot.replace(",\"--fidelity=shot\"", ""), cycle, "{threads} threads");
        }
    }
}

#[test]
fn a_folder_of_results_is_the_same_whatever_the_threads_and_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    for frames in ["1", "2", "4"] {
        let run = |threads: &str| {
            let fixed = [
                "run",
                "--waves",
                "none",
                "--frames",
                frames,
                "-s",
                "firmware.shots_per_frame=500",
            ];
            stdout(folder.path(), &[&fixed[..], &["-o", threads, "--threads", threads]].concat());
            ["summary.json", "histogram.csv", "histogram.svg"]
                .map(|name| std::fs::read(folder.path().join(threads).join(name)).unwrap())
        };
        assert!(run("1") == run("3"), "{frames} frames");
    }
}

#[test]
fn histogram_prints_the_same_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str| {
        let fixed = ["run", "--json", "--fidelity", "histogram", "--frames", "200", "--threads"];
        stdout(folder.path(), &[&fixed[..], &[threads]].concat())
    };
    assert_eq!(run("1"), run("3"));
    let value =
        json(folder.path(), &["run", "--json", "--fidelity", "histogram", "--frames", "200"]);
    let depth_m = value["depth"]["mean_m"].as_f64().unwrap();
    assert!((depth_m - 0.5).abs() < 1e-3, "{depth_m}");
    assert_eq!(value["frames"].as_array().unwrap().len(), 200);
}

#[test]
fn frames_drawn_at_once_have_no_cycles_per_second() {
    let folder = tempfile::tempdir().unwrap();
    let run = |fidelity| {
        let args = ["run", "--waves", "none", "--frames", "3", "--fidelity", fidelity];
        stdout(folder.path(), &args)
    };
    let drawn = run("histogram");
    assert!(drawn.contains("3 frames drawn in ") && !drawn.contains("per second"), "{drawn}");
    assert!(run("shot").contains("million cycles per second"));
}

#[test]
fn what_a_fidelity_cannot_show_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |args: &[&str]| refused(folder.path(), &[&["run"], args].concat());
    for fidelity in ["shot", "histogram"] {
        let given = ["--fidelity", fidelity];
        for (option, value) in [
            ("--waves", "vcd"),
            ("--window", "shot:0..2"),
            ("--signals", "tdc.*"),
            ("--events", "e.csv"),
        ] {
            let text = refused(&[&given[..], &[option, value]].concat());
            assert!(text.contains(option) && text.contains(fidelity), "{text}");
        }
        let text = refused(&[&["tdc_validation"], &given[..]].concat());
        assert!(text.contains("report.tdc"), "{text}");
    }
    for (key, field) in [
        ("firmware.mode=1", "firmware.mode = 1: expected 0"),
        ("control=[{at_us=10,laser_freq=1}]", "control = 1: expected 0"),
        ("pll.jitter_rms_ps=7.7", "pll.jitter_rms_ps = 7.7: expected 0"),
        ("firmware.dsp_en=false", "firmware.dsp_en = false: expected true"),
        ("firmware.rst=true", "firmware.rst = true: expected false"),
    ] {
        let text = refused(&["--fidelity", "histogram", "-s", key]);
        let expected = format!("scenario kc705: {field} for --fidelity histogram: ");
        assert!(text.contains(&expected), "{text}");
    }
    let text = refused(&["spad_validation", "--fidelity", "histogram", "-s", "firmware.mode=1"]);
    assert!(text.contains("firmware.mode"), "{text}");
    let text = refused(&["histogram_validation", "--fidelity", "histogram"]);
    assert!(text.contains("stimulus"), "{text}");
    for threads in ["0", "-1", "many", "70000"] {
        assert!(refused(&["--threads", threads]).contains("--threads"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
}
