//! `tofsim train`: what it writes is decided by seed and recipe alone.

mod own_grid;

use std::fs;
use std::path::Path;

use tofsim::network::Network;
use tofsim_learn::training::recipe::Recipe;

use crate::common::{files, json, output, refused, stdout};

/// Arguments of a training of about a second.
const SMALL: [&str; 8] = [
    "train",
    "--quick",
    "--profile",
    "uniform",
    "--seed",
    "2",
    "--with",
    "stages=[{candidates=2,epochs=5,samples=402},{candidates=1,epochs=5,samples=603}]",
];
const END: [&str; 2] =
    ["--with", "finish={candidates=1,blocks=2,epochs=5,samples=603,least=0.7,most=1.5,power=0.7}"];

fn train(folder: &Path, to: &str, more: &[&str]) -> String {
    stdout(folder, &[&SMALL[..], &END, more, &["-o", to]].concat())
}

fn read(folder: &Path, path: &str) -> String {
    fs::read_to_string(folder.join(path)).unwrap()
}

#[test]
fn the_same_command_writes_the_same_files_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    train(folder, "a", &["--threads", "1"]);
    train(folder, "b", &["--threads", "3"]);
    let names = ["accuracy.csv", "checkpoint", "curve.csv", "curve.svg", "network.toml"];
    assert_eq!(files(&folder.join("a")), names);
    for name in names {
        assert!(read(folder, &format!("a/{name}")) == read(folder, &format!("b/{name}")), "{name}");
    }
    let network = Network::load(&folder.join("a/network.toml")).unwrap();
    assert_eq!(network.training.chain, "uniform");
    let command = network.training.command.unwrap();
    assert!(
        command.starts_with("tofsim train --profile uniform --seed 2 --quick --with"),
        "{command}"
    );
    assert_eq!(network.accuracy.unwrap().distances_m, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    assert_eq!(read(folder, "a/accuracy.csv").lines().count(), 53);
}

#[test]
fn plain_trainlm_stops_by_its_validation_and_has_no_end_of_ours() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let few = "stages=[{candidates=1,epochs=1000,samples=603}]";
    let start = ["train", "--recipe", "trainlm", "--profile", "ideal", "--seed", "1"];
    stdout(folder, &[&start[..], &["--with", few, "--with", "validation=402", "-o", "a"]].concat());
    let curve = read(folder, "a/curve.csv");
    let last: Vec<_> = curve.lines().last().unwrap().split(',').collect();
    let [stage, block, start, epochs, cost, _, validation, ratio] = last[..] else {
        panic!("{last:?}")
    };
    assert_eq!([stage, block, start, ratio], ["0", "0", "0", ""]);
    assert!(epochs.parse::<u32>().unwrap() < 1000, "{epochs} epochs");
    let [cost, validation] = [cost, validation].map(|text| text.parse::<f64>().unwrap());
    // In square metres: the histograms that it learned by are closer than those that stopped it.
    assert!(cost < validation && validation < 0.02f64.powi(2), "{cost} {validation}");
    let origin = Network::load(&folder.join("a/network.toml")).unwrap().training.origin;
    assert_eq!(origin, "Levenberg-Marquardt on simulated histograms");
}

#[test]
#[ignore = "long: ./check --full"]
fn a_training_that_was_stopped_ends_as_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let whole = train(folder, "whole", &[]);
    assert_eq!(train(folder, "parts", &["--checkpoints", "1"]), "");
    assert_eq!(files(&folder.join("parts")), ["checkpoint"]);
    // Within the first stage, at its end, and within the last block.
    for count in ["1", "2", "2"] {
        assert_eq!(train(folder, "parts", &["--resume", "--checkpoints", count]), "");
    }
    assert_eq!(train(folder, "parts", &["--resume"]), whole);
    for name in files(&folder.join("whole")) {
        let [a, b] = ["whole", "parts"].map(|of| read(folder, &format!("{of}/{name}")));
        assert!(a == b, "{name}");
    }
    // What is over is only written again.
    assert_eq!(train(folder, "parts", &["--resume"]), whole);
}

#[test]
#[ignore = "long: ./check --full"]
fn formats_that_are_not_the_thesis_s_are_trained_for_and_built() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let largest = |of: &[f64]| of.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    // So short a training minds the penalties only if they are steep.
    let train = |to: &str, more: &[&str]| {
        train(folder, to, &[&["--with", "limits.penalty=50"], more].concat())
    };
    train("a", &["--lut-bits", "12", "--format", "w2=16.14"]);
    let w2 = Network::load(&folder.join("a/network.toml")).unwrap().twin().w2;
    assert!(largest(&w2) > 0.125, "{w2:?}");

    // A word of W2 that ends at 1/8 keeps the weights there, or they would not fit.
    train("b", &["--lut-bits", "9", "--format", "w2=12.14", "--format", "w1=12.19"]);
    let names = ["accuracy.csv", "checkpoint", "curve.csv", "curve.svg", "network.toml"];
    assert_eq!(files(&folder.join("b")), names);
    assert!(stdout(folder, &["rerun", "b/network.toml"]).contains("the same"));
    let network = Network::load(&folder.join("b/network.toml")).unwrap();
    assert_eq!((network.datapath.address_bits, network.datapath.w1.width), (9, 12));
    let w2 = network.twin().w2;
    assert!(largest(&w2) < 0.125, "{w2:?}");

    // The errors that are written are those with a table of 16 steps, and not with one of 4096.
    train("c", &["--lut-bits", "4", "--with", "table_noise=0.0"]);
    let text = read(folder, "c/network.toml").replace("address_bits = 4", "address_bits = 12");
    std::fs::write(folder.join("c.toml"), text).unwrap();
    let fine = json(folder, &["evaluate", "c.toml", "--rows", "5100", "--check", "0", "--json"]);
    let fine_mm = fine["estimators"][0]["all"]["two_sd_mm"].as_f64().unwrap();
    let table = read(folder, "c/accuracy.csv");
    let column = |row: &str| row.split(',').nth(3).unwrap().parse::<f64>().unwrap();
    let coarse_mm = table.lines().skip(2).map(column).sum::<f64>() / 51.0;
    assert!(coarse_mm > 2.0 * fine_mm, "{coarse_mm} {fine_mm}");

    for (option, expected) in [
        ("--lut-bits=17", "address_bits = 17: expected 4 to 16"),
        ("--format=b1=16.24", "b1.fraction = 24: expected 0 to 23, as w1 has"),
        ("--format=w3=16.24", "WORD one of w1, b1, w2, b2, l1_out"),
    ] {
        let error = refused(folder, &["train", "--quick", option]);
        assert!(error.contains(expected), "{error}");
    }
    let other = ["--with", "limits.penalty=50", "--resume", "--lut-bits", "10", "-o", "b"];
    let error = refused(folder, &[&SMALL[..], &END, &other].concat());
    assert!(error.contains("settings.formats."), "{error}");
}

#[test]
#[ignore = "long: ./check --full"]
fn a_validation_error_that_grows_ends_a_stage_where_it_was_least() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Fewer histograms than a network of eight neurons has parameters.
    let stages =
        "stages=[{candidates=2,epochs=60,samples=402},{candidates=1,epochs=5,samples=603}]";
    let with = ["--with", stages, "--with", "validation=1005", "--with", "optimiser.max_fail=4"];
    train(folder, "whole", &with);
    let curve = read(folder, "whole/curve.csv");
    let rows: Vec<Vec<f64>> = curve
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    for start in [0.0, 1.0] {
        let first: Vec<_> = rows.iter().filter(|row| row[0] == 0.0 && row[2] == start).collect();
        let (last, validation) = (first[first.len() - 1], |row: &&Vec<f64>| row[6]);
        assert!(last[3] < 60.0, "{last:?}: it goes on for all epochs");
        let least = first.iter().map(validation).fold(f64::INFINITY, f64::min);
        assert!(last[6] <= least && last[6] > last[4], "{last:?} {least}");
    }
    // Stopped and resumed in its midst it ends alike.
    train(folder, "parts", &[&with[..], &["--checkpoints", "2"]].concat());
    train(folder, "parts", &[&with[..], &["--resume"]].concat());
    assert!(read(folder, "parts/curve.csv") == curve);
    assert!(read(folder, "parts/network.toml") == read(folder, "whole/network.toml"));
    let few = refused(folder, &["train", "--with", "validation=100"]);
    assert!(few.contains("validation = 100: expected 201 or more"), "{few}");
}

#[test]
fn a_checkpoint_of_another_training_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let missing = refused(folder, &["train", "--resume", "-o", "none"]);
    assert!(missing.contains("none/checkpoint"), "{missing}");
    train(folder, "a", &["--checkpoints", "1"]);
    let refusal = |more: &[&str]| {
        refused(folder, &[&SMALL[..], &END, &["--resume", "-o", "a"], more].concat())
    };
    let error = refusal(&["--with", "table_noise=0.001"]);
    assert!(error.contains("settings.table_noise = 0.4096: of another training"), "{error}");
    assert!(refusal(&["-s", "spad.pdp=0.013"]).contains("settings.scenario"));
    let path = folder.join("a/checkpoint");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("tofsim.checkpoint/2", "tofsim.checkpoint/1", 1)).unwrap();
    assert!(
        refusal(&[]).contains("schema = tofsim.checkpoint/1: expected \"tofsim.checkpoint/2\"")
    );
    let digit = text.find("x = [").unwrap() + "x = [".len() + 4;
    let changed = text[digit..].find(|letter: char| letter.is_ascii_digit()).unwrap() + digit;
    let other = if &text[changed..=changed] == "7" { "3" } else { "7" };
    fs::write(&path, [&text[..changed], other, &text[changed + 1..]].concat()).unwrap();
    assert!(refusal(&[]).contains("does not match its checksum"));
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    assert!(refusal(&[]).contains("no checkpoint"));
}

#[test]
fn options_reach_the_recipe_and_what_makes_no_sense_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("mine.toml"), "table_noise = 0.5\n[limits]\nb1_share = 0.9\n").unwrap();
    let text = stdout(
        folder,
        &[
            "train",
            "--recipe",
            "mine.toml",
            "--with",
            "limits.b1_share=0.75",
            "--starts",
            "3",
            "--print-recipe",
        ],
    );
    let recipe: Recipe = toml::from_str(&text).unwrap();
    assert_eq!((recipe.table_noise, recipe.limits.b1_share), (0.5, 0.75));
    let candidates: Vec<_> = recipe.stages.iter().map(|stage| stage.candidates).collect();
    assert_eq!(candidates, [3, 3, 3, 3]);
    let error = refused(folder, &["train", "--with", "limit.b1=3"]);
    assert!(
        error.contains("--with limit.b1=3")
            && error.contains("unknown key; did you mean `limits`?"),
        "{error}"
    );
    fs::write(folder.join("bad.toml"), "neurons = \"many\"\n").unwrap();
    assert!(refused(folder, &["train", "--recipe", "bad.toml"]).contains("bad.toml"));
    assert!(refused(folder, &["train", "--neurons", "0"]).contains("neurons = 0"));
    assert!(refused(folder, &["train", "--profile", "none"]).contains("none"));
    assert!(refused(folder, &["train", "-s", "firmware.mode=1"]).contains("firmware.mode"));
}

#[test]
fn other_numbers_of_neurons_are_trained_and_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let args = [&SMALL[..], &END, &["--neurons", "4", "-o", "four"]].concat();
    stdout(folder, &args);
    let network = Network::load(&folder.join("four/network.toml")).unwrap();
    assert_eq!((network.fixed.neurons(), network.training.seed), (4, Some(2)));
    assert_eq!(network.training.data.as_ref().map(String::len), Some(16));
    assert!(network.training.command.unwrap().ends_with("--neurons 4"));
    assert_eq!(network.accuracy.unwrap().mean_mm.unwrap().len(), 6);
    let set = ["-s", "estimator.network=four/network.toml", "-s", "firmware.shots_per_frame=50"];
    let run = json(folder, &[&["run", "--waves", "none", "--json"], &set[..]].concat());
    assert_eq!(run["frames"][0]["estimator_cycles"], 263 + 2);
    let error = refused(folder, &["train", "--neurons", "33"]);
    assert!(error.contains("neurons = 33: expected 32 at most"), "{error}");
}

#[test]
fn weights_that_fit_no_words_are_saturated_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let loose = ["--with", "limits.penalty=0.0001", "-o", "wide"];
    let done = output(folder, &[&SMALL[..], &END, &loose].concat());
    let told = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success() && told.contains("do not fit their words"), "{told}");
    let network = Network::load(&folder.join("wide/network.toml")).unwrap();
    let fixed = &network.fixed;
    let words = fixed.w1.iter().flatten().chain(&fixed.b1).chain(&fixed.w2);
    assert!(words.into_iter().any(|word| [-32768, 32767].contains(word)));
}

#[test]
#[ignore = "long: ./check --full"]
fn a_quick_training_finds_distances() {
    let folder = tempfile::tempdir().unwrap();
    let report = json(folder.path(), &["train", "--quick", "--json", "-o", "quick"]);
    assert_eq!(report["schema"], "tofsim.train/1");
    let spread = report["two_sd_mm"].as_array().unwrap();
    assert_eq!(spread.len(), 51);
    let mean = spread.iter().map(|x| x.as_f64().unwrap()).sum::<f64>() / 51.0;
    assert!(mean < 25.0, "{mean}");
    let depth = json(
        folder.path(),
        &[
            "run",
            "--json",
            "--waves",
            "none",
            "--fidelity",
            "histogram",
            "-s",
            "target.distance_m=0.3",
            "-s",
            "estimator.network=quick/network.toml",
        ],
    );
    let depth = depth["frames"][0]["depth_m"].as_f64().unwrap();
    assert!((depth - 0.3).abs() < 0.05, "{depth}");
}
