//! Histograms through `estimate`, against a separate and deliberately naive integer implementation.

mod likelihood;
mod naive;
mod sensor;
mod two_echoes;

use std::path::Path;
use std::process::Command;

use tofsim::network::{Histogram, Network, estimate};

use crate::common::{csv, empty, json, npy, refused, stdout};

use naive::{Naive, Random, activation, histograms};

#[test]
fn random_networks_and_histograms_give_the_naive_integers() {
    let directory = tempfile::tempdir().unwrap();
    let mut random = Random(1);
    let ends = [8, 16, 32].map(|neurons| [(neurons, -32768), (neurons, 32767)]).concat();
    let mut networks = ends
        .into_iter()
        .map(|(neurons, weight)| Naive::constant(neurons, weight))
        .collect::<Vec<_>>();
    networks.extend((0..30).map(|k| Naive::random(&mut random, 8, k % 10)));
    networks.extend((0..32).map(|k| Naive::random(&mut random, 1 + k as usize % 32, k % 10)));
    let histograms = histograms(&mut random);
    let mut saturated = 0;
    let mut between = 0;
    for (k, naive) in networks.iter().enumerate() {
        let path = directory.path().join(format!("{k}.toml"));
        std::fs::write(&path, naive.toml()).unwrap();
        let params = Network::load(&path).unwrap().params(&Default::default());
        for (n, histogram) in histograms.iter().enumerate() {
            let (depth, sums) = naive.estimate(histogram);
            let found = estimate(&params, histogram);
            let found_sums = found.l1_in.map(|sum| i128::from(sum.get()));
            assert_eq!(found_sums[..sums.len()], sums[..], "{k}, {n}");
            assert!(found_sums[sums.len()..].iter().all(|&sum| sum == 0), "{k}, {n}");
            assert_eq!(i128::from(found.depth.get()), depth, "network {k}, histogram {n}");
            saturated += sums.iter().filter(|sum| sum.abs() > 4 << 23).count();
            between += sums.iter().filter(|sum| sum.abs() < 4 << 23).count();
        }
    }
    assert!(saturated > 500 && between > 500, "one-sided: {saturated} and {between}");
}

#[test]
fn every_address_of_the_activation_table_is_the_naive_one() {
    let table = tofsim::firmware::depth_estimator::datapath::Datapath::THESIS.table();
    for address in -2048..2048i128 {
        let place = address.rem_euclid(4096) as usize;
        assert_eq!(i128::from(table[place]), activation(address), "address {address}");
    }
}

/// Runs the program, and returns its JSON.
fn run(arguments: &[&Path]) -> serde_json::Value {
    let program = env!("CARGO_BIN_EXE_tofsim");
    let output = Command::new(program).args(["estimate", "--json"]).args(arguments).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn the_program_prints_the_naive_integers() {
    let directory = tempfile::tempdir().unwrap();
    let mut random = Random(2);
    let naive = Naive::random(&mut random, 8, 4);
    let network = directory.path().join("network.toml");
    std::fs::write(&network, naive.toml()).unwrap();
    let histograms = histograms(&mut random);
    let expect = |json: &serde_json::Value, histogram: &Histogram| {
        let (depth, sums) = naive.estimate(histogram);
        assert_eq!(json["depth_raw"], format!("{:09x}", depth.rem_euclid(1 << 36)));
        let depth_m = depth as f64 / (1u64 << 29) as f64;
        // The parser of this test may miss the last bit.
        assert!((json["depth_m"].as_f64().unwrap() - depth_m).abs() < 1e-12);
        let found = json["l1_in"].as_array().unwrap().iter().map(|sum| sum.as_i64().unwrap());
        assert_eq!(found.map(i128::from).collect::<Vec<_>>(), sums);
    };

    let single = directory.path().join("one.csv");
    std::fs::write(&single, csv(&histograms[9])).unwrap();
    let json = run(&[&single, Path::new("--network"), &network]);
    assert_eq!(json["schema"], "tofsim.estimate/1");
    expect(&json, &histograms[9]);
    expect(&json["histograms"][0], &histograms[9]);

    let many = directory.path().join("many.npy");
    let data: Vec<u8> =
        histograms.iter().flatten().flat_map(|&count| (count as u16).to_le_bytes()).collect();
    std::fs::write(&many, npy("<u2", &format!("({}, 256)", histograms.len()), &data)).unwrap();
    let json = run(&[&single, &many, Path::new("--network"), &network]);
    assert!(json.get("depth_raw").is_none());
    let rows = json["histograms"].as_array().unwrap();
    assert_eq!(rows.len(), 1 + histograms.len());
    expect(&rows[0], &histograms[9]);
    for (index, histogram) in histograms.iter().enumerate() {
        assert_eq!(rows[1 + index]["index"], 1 + index);
        expect(&rows[1 + index], histogram);
    }
}

#[test]
fn an_explanation_has_every_value_and_a_budget_that_adds_up() {
    let histogram = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stimuli/histograms/kc705.csv");
    let json = run(&[Path::new(histogram), Path::new("--explain")]);
    let explained = &json["histograms"][0]["explanation"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let budget = &explained["budget"];
    let parts = ["hidden_weights_mm", "address_mm", "table_mm", "output_weights_mm"];
    let sum: f64 = parts.iter().map(|part| number(&budget[part])).sum();
    assert!((sum - number(&budget["total_mm"])).abs() < 1e-9);
    let depth = &explained["depth"];
    assert_eq!(number(&depth["fixed"]), number(&json["depth_m"]));
    let total_mm = 1e3 * (number(&depth["fixed"]) - number(&depth["float"]));
    assert!((total_mm - number(&budget["total_mm"])).abs() < 1e-9);
    for (neuron, sum) in explained["neurons"].as_array().unwrap().iter().zip(0..) {
        assert_eq!(neuron["l1_in"]["word"], json["l1_in"][sum]);
        let saturated = number(&neuron["l1_in"]["fixed"]).abs() > 4.0;
        assert_eq!(neuron["saturated"], saturated);
    }

    let program = Command::new(env!("CARGO_BIN_EXE_tofsim"))
        .args(["estimate", histogram, "--explain"])
        .output()
        .unwrap();
    let text = String::from_utf8(program.stdout).unwrap();
    assert!(text.contains("010021340") && text.contains("saturated: 2 of 8 neurons"), "{text}");
    assert_eq!(text.lines().filter(|line| line.trim_start().starts_with("l1_out")).count(), 8);
}

#[test]
fn a_network_file_that_is_not_there_or_no_text_is_an_error() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("latin.toml");
    std::fs::write(&path, b"schema = 'a'\n# \xe9\n").unwrap();
    let fault = |path: &Path| Network::load(path).unwrap_err().to_string();
    assert!(fault(&path).ends_with("latin.toml:2:3: expected UTF-8 text"));
    assert!(fault(directory.path()).contains("cannot read: Is a directory"));
    assert!(fault(&directory.path().join("none.toml")).contains("cannot read: No such file"));
}

#[test]
fn every_estimator_answers_on_csv_npy_and_parquet_alike() {
    let folder = empty();
    let folder = folder.path();
    let shape =
        ["--grid", "target.distance_m=0.2,0.5", "--repeats", "1", "--format", "npy,parquet"];
    stdout(folder, &[&["dataset", "-o", "d"], &shape[..]].concat());
    let all = [
        "--estimator",
        "network,network-float,centroid,peak,likelihood,likelihood_estimator,matched,subtraction",
    ];
    let of = |file: &str| {
        let report = json(folder, &[&["estimate", file, "--json"], &all[..]].concat());
        report["histograms"].as_array().unwrap().clone()
    };
    let (npy, parquet) = (of("d/histograms.npy"), of("d/dataset.parquet"));
    assert_eq!(npy.len(), 2);
    for (place, distance_m) in [0.2, 0.5].into_iter().enumerate() {
        assert_eq!(npy[place]["estimates"], parquet[place]["estimates"]);
        assert_eq!(npy[place]["depth_raw"], parquet[place]["depth_raw"]);
        let estimates = npy[place]["estimates"].as_array().unwrap();
        assert_eq!(estimates[0]["depth_m"], npy[place]["depth_m"]);
        for (likelihood, name) in estimates[4..].iter().zip(["likelihood", "likelihood_estimator"])
        {
            assert_eq!(likelihood["estimator"], name);
            assert!((likelihood["depth_m"].as_f64().unwrap() - distance_m).abs() < 0.002);
        }
        assert_eq!(estimates[7]["failure"], "no dark frame");
    }
    // The chain decides what the likelihood makes of the same counts.
    let text = stdout(folder, &[&["estimate", "d/dataset.parquet"], &all[..]].concat());
    assert!(text.contains("likelihood") && text.contains("no dark frame"), "{text}");
    let file = ["estimate", "d/histograms.npy", "--json", "--estimator", "likelihood"];
    let other = json(folder, &[&file[..], &["-s", "tdc.profile=ideal"]].concat());
    assert_ne!(other["histograms"][1]["estimates"][0], npy[1]["estimates"][4]);
}

#[test]
fn floats_of_four_bytes_are_counts_where_they_are_whole() {
    let folder = empty();
    let write = |value: f32| {
        let mut counts = [7f32; 512];
        counts[300] = value;
        let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 256), }\n";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(counts.iter().flat_map(|count| count.to_le_bytes()));
        std::fs::write(folder.path().join("f4.npy"), bytes).unwrap();
    };
    write(9.0);
    let report = json(folder.path(), &["estimate", "f4.npy", "--json"]);
    assert_eq!(report["histograms"].as_array().unwrap().len(), 2);
    for (value, shown) in [(0.5, "0.5"), (-1.0, "-1"), (65_536.0, "65536"), (f32::NAN, "NaN")] {
        write(value);
        let error = refused(folder.path(), &["estimate", "f4.npy"]);
        let expected =
            format!("histogram 1, bin 44 = {shown}: expected a whole number from 0 to 65535");
        assert!(error.contains(&expected), "{error}");
    }
}
