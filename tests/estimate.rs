//! Histograms through `estimate`, against a separate and deliberately naive integer implementation.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use tofsim::histogram_file;
use tofsim::network::{Histogram, Network, estimate};

/// A small generator of random words (SplitMix64).
struct Random(u64);

impl Random {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.word() % limit
    }

    /// A 16-bit word, now and then one of its ends, made smaller by a shift.
    fn weight(&mut self, shift: u32) -> i128 {
        let word = match self.below(16) {
            0 => -32768,
            1 => 32767,
            _ => i128::from(self.word() as i16),
        };
        word >> shift
    }
}

/// A network as plain integers.
struct Naive {
    w1: Vec<Vec<i128>>,
    b1: Vec<i128>,
    w2: Vec<i128>,
    b2: i128,
}

/// The signed integer that the low 36 bits of a number make.
fn wrap_36(number: i128) -> i128 {
    let low = number.rem_euclid(1 << 36);
    if low >= 1 << 35 { low - (1 << 36) } else { low }
}

/// tanh(address / 512) x 2^15 to the nearest integer, at most 32767.
fn activation(address: i128) -> i128 {
    let exact = (address.abs() as f64 / 512.0).tanh() * 32768.0;
    let nearest = ((exact + 0.5).floor() as i128).min(32767);
    if address < 0 { -nearest } else { nearest }
}

impl Naive {
    fn random(random: &mut Random, shift: u32) -> Naive {
        Naive {
            w1: (0..8).map(|_| (0..256).map(|_| random.weight(shift)).collect()).collect(),
            b1: (0..8).map(|_| random.weight(shift)).collect(),
            w2: (0..8).map(|_| random.weight(0)).collect(),
            b2: random.weight(0),
        }
    }

    /// Every weight the same.
    fn constant(weight: i128) -> Naive {
        Naive {
            w1: vec![vec![weight; 256]; 8],
            b1: vec![weight; 8],
            w2: vec![weight; 8],
            b2: weight,
        }
    }

    /// Depth and sums as integers.
    fn estimate(&self, histogram: &Histogram) -> (i128, Vec<i128>) {
        let mut sums = Vec::new();
        let mut depth = self.b2 * 4096;
        for neuron in 0..8 {
            let mut sum = self.b1[neuron] * 1024;
            for bin in 0..256 {
                sum += self.w1[neuron][bin] * i128::from(histogram[bin]);
            }
            let sum = wrap_36(sum);
            // The nearest multiple of 2^14, halves up.
            let address = (sum + 8192).div_euclid(16384).clamp(-2048, 2047);
            depth += self.w2[neuron] * activation(address);
            sums.push(sum);
        }
        (wrap_36(depth), sums)
    }

    fn toml(&self) -> String {
        let mut text = String::from(
            "schema = 'tofsim.network/1'\ndescription = 'random'\n\
             training = { origin = 'none', chain = 'none' }\n\
             scaling = { input = 'counts', output = 'metres', normalisation = 'folded' }\n\
             [formats]\nw1 = { width = 16, fraction = 23 }\nb1 = { width = 16, fraction = 13 }\n\
             w2 = { width = 16, fraction = 14 }\nb2 = { width = 16, fraction = 17 }\n\
             l1_out = { width = 16, fraction = 15 }\n\
             tansig = { address_bits = 12, range = 4 }\n[integers]\n",
        );
        let (w1, b1, w2, b2) = (&self.w1, &self.b1, &self.w2, self.b2);
        writeln!(text, "w1 = {w1:?}\nb1 = {b1:?}\nw2 = {w2:?}\nb2 = {b2}").unwrap();
        text
    }
}

/// Hand-made extremes, then random histograms of at most 65,535 hits.
fn histograms(random: &mut Random) -> Vec<Histogram> {
    let one = |bin: usize, count| std::array::from_fn(|k| if k == bin { count } else { 0 });
    let alternating = |odd| std::array::from_fn(|k| if k % 2 == odd { 500 } else { 0 });
    let mut list = vec![[0; 256], one(0, 30_000), one(255, 30_000), one(100, 65_535)];
    list.extend([alternating(0), alternating(1), [255; 256], one(128, 1)]);
    for _ in 0..24 {
        let hits = random.below(65_536);
        let (first, span) = (random.below(200), 1 + random.below(56));
        let mut histogram = [0; 256];
        for _ in 0..hits {
            histogram[(first + random.below(span)) as usize] += 1;
        }
        list.push(histogram);
    }
    list
}

fn csv(histogram: &Histogram) -> String {
    let mut text = String::from("# made by hand\nbin,count\n");
    for (bin, count) in histogram.iter().enumerate() {
        writeln!(text, "{bin},{count}").unwrap();
    }
    text
}

/// An `.npy` file of that type and shape, by the format's description.
fn npy(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let dict = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{dict:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn random_networks_and_histograms_give_the_naive_integers() {
    let directory = tempfile::tempdir().unwrap();
    let mut random = Random(1);
    let mut networks: Vec<Naive> = [-32768, 32767].map(Naive::constant).into();
    networks.extend((0..30).map(|k| Naive::random(&mut random, k % 10)));
    let histograms = histograms(&mut random);
    let mut saturated = 0;
    let mut between = 0;
    for (k, naive) in networks.iter().enumerate() {
        let path = directory.path().join(format!("{k}.toml"));
        std::fs::write(&path, naive.toml()).unwrap();
        let params = Network::load(&path).unwrap().params();
        for (n, histogram) in histograms.iter().enumerate() {
            let (depth, sums) = naive.estimate(histogram);
            let found = estimate(&params, histogram);
            assert_eq!(found.l1_in.map(|sum| i128::from(sum.get())), sums[..], "{k}, {n}");
            assert_eq!(i128::from(found.depth.get()), depth, "network {k}, histogram {n}");
            saturated += sums.iter().filter(|sum| sum.abs() > 4 << 23).count();
            between += sums.iter().filter(|sum| sum.abs() < 4 << 23).count();
        }
    }
    assert!(saturated > 500 && between > 500, "one-sided: {saturated} and {between}");
}

#[test]
fn every_address_of_the_activation_table_is_the_naive_one() {
    let table = tofsim::network::roms::tansig_table();
    for address in -2048..2048 {
        let place = (address as i128).rem_euclid(4096) as usize;
        assert_eq!(i128::from(table[place].get()), activation(address), "address {address}");
    }
}

/// What the program prints as JSON.
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
    let naive = Naive::random(&mut random, 4);
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
    let data: Vec<u8> = histograms.iter().flatten().flat_map(|count| count.to_le_bytes()).collect();
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
fn every_type_of_whole_number_reads_the_same_in_either_byte_order() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h.npy");
    let histogram: Histogram = std::array::from_fn(|bin| (bin % 100) as u16);
    let check = |descr: &str, bytes: fn(u16) -> Vec<u8>| {
        let data: Vec<u8> = histogram.iter().flat_map(|&count| bytes(count)).collect();
        std::fs::write(&path, npy(descr, "(256,)", &data)).unwrap();
        assert!(histogram_file::single(&path).unwrap() == histogram, "{descr}");
    };
    check("|u1", |n| vec![n as u8]);
    check("|i1", |n| vec![n as u8]);
    check("<u2", |n| n.to_le_bytes().into());
    check(">i2", |n| n.to_be_bytes().into());
    check("<u4", |n| u32::from(n).to_le_bytes().into());
    check(">i4", |n| i32::from(n).to_be_bytes().into());
    check(">u8", |n| u64::from(n).to_be_bytes().into());
    check("<i8", |n| i64::from(n).to_le_bytes().into());
    check("<f8", |n| f64::from(n).to_le_bytes().into());
    check(">f8", |n| f64::from(n).to_be_bytes().into());
}

/// The message about a file of those bytes.
fn fault(bytes: &[u8]) -> String {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h");
    std::fs::write(&path, bytes).unwrap();
    let error = histogram_file::open(&path)
        .and_then(|mut list| list.find(Result::is_err).expect("a histogram in error").map(drop));
    let message = error.unwrap_err().to_string();
    let prefix = path.display().to_string();
    message.strip_prefix(&prefix).expect("the file's name first").to_owned()
}

#[test]
fn a_faulty_csv_is_refused_with_line_column_and_value() {
    let good = csv(&[7; 256]);
    let swap = |from: &str, to: &str| fault(good.replacen(from, to, 1).as_bytes());
    let contains = |message: String, parts: [&str; 2]| {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}: {parts:?}");
    };
    let count = "expected a whole number from 0 to 65535";
    contains(
        swap("bin,count", "bin;count"),
        [":2:1: bin;count", "expected the header `bin,count`"],
    );
    contains(fault(b""), ["", "expected the header `bin,count`"]);
    contains(swap("\n9,7", "\n9,-1"), [":12:3: count = -1", count]);
    contains(swap("\n9,7", "\n9,1.5"), [":12:3: count = 1.5", count]);
    contains(swap("\n9,7", "\n9,many"), [":12:3: count = many", count]);
    contains(swap("\n9,7", "\n9,65536"), [":12:3: count = 65536", count]);
    contains(swap("\n9,7", "\n9,"), [":12:3: count", count]);
    contains(swap("\n9,7", "\n9,7,7"), [":12:1:", "3 fields, expected 2"]);
    contains(swap("\n9,7", "\n9 7"), [":12:1:", "1 fields, expected 2"]);
    let order = "expected 9: bins 0 to 255, each once, in order";
    contains(swap("\n9,7", ""), [":12:1: bin = 10", order]);
    contains(swap("\n9,7", "\n8,7"), [":12:1: bin = 8", order]);
    contains(swap("\n9,7", "\n-9,7"), [":12:1: bin = -9", order]);
    contains(swap("\n255,7", ""), ["", "255 rows, expected 256"]);
    contains(fault(format!("{good}256,7\n").as_bytes()), [":259:1:", "expected 256 rows"]);
    let allowed = "the estimator's bit widths allow 65535 hits in all";
    contains(swap("\n9,7", "\n9,63751"), ["total = 65536", allowed]);
    contains(fault(b"bin,count\n0,\xff\n"), [":2:3:", "expected CSV in UTF-8"]);
    contains(fault(&vec![b'1'; 2 << 20]), ["", "more than 1 MiB, expected CSV"]);
}

#[test]
fn a_csv_may_have_comments_blank_lines_spaces_and_windows_line_ends() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h.csv");
    let histogram: Histogram = std::array::from_fn(|bin| (bin as u16 * 31) % 200);
    let text =
        csv(&histogram).replace(',', ", ").replace('\n', "\r\n").replace("\n77,", "\n\n#\n77,");
    std::fs::write(&path, format!("\u{feff}{text}")).unwrap();
    assert!(histogram_file::single(&path).unwrap() == histogram);
}

#[test]
fn a_faulty_npy_is_refused_with_shape_type_or_place() {
    let zeros = [0; 4096];
    assert!(fault(&npy("<u2", "(255,)", &zeros)).contains("shape = (255): expected (256) or (n,"));
    assert!(fault(&npy("<u2", "(256, 2)", &zeros)).contains("shape = (256, 2): expected"));
    assert!(fault(&npy("<u2", "(2, 2, 256)", &zeros)).contains("shape = (2, 2, 256): expected"));
    assert!(fault(&npy("<u2", "(0, 256)", &[])).contains("shape = (0, 256): expected"));
    assert!(fault(&npy("<f4", "(256,)", &zeros)).contains("dtype = '<f4': expected integers"));
    assert!(fault(&npy("|b1", "(256,)", &zeros)).contains("dtype = '|b1': expected integers"));
    let short = fault(&npy("<u2", "(2, 256)", &zeros[..1022]));
    assert_eq!(short, ": histogram 1, bin 255: the file ends here, expected 2 histograms");
    let word = |descr, bin: usize, bytes: &[u8]| {
        let mut data = zeros;
        data[bin * bytes.len()..][..bytes.len()].copy_from_slice(bytes);
        fault(&npy(descr, "(256,)", &data))
    };
    let count = "expected a whole number from 0 to 65535";
    let at_3 = |value| format!(": histogram 0, bin 3 = {value}: {count}");
    assert_eq!(word("<i2", 3, &(-5i16).to_le_bytes()), at_3("-5"));
    assert_eq!(word("<i4", 3, &65_536i32.to_le_bytes()), at_3("65536"));
    assert_eq!(word("<f8", 3, &2.5f64.to_le_bytes()), at_3("2.5"));
    assert_eq!(word("<f8", 3, &f64::NAN.to_le_bytes()), at_3("NaN"));
    let total = fault(&npy("<u2", "(256,)", &[1; 512]));
    assert_eq!(
        total,
        ": total of histogram 0 = 65792: the estimator's bit widths allow 65535 hits in all"
    );
    assert!(fault(&npy("<u2", "(256,)", &zeros)[..40]).contains("not a whole .npy"));
}

#[test]
fn a_histogram_file_that_is_not_there_or_no_file_is_an_error() {
    for path in ["/nonexistent/h.csv", "/"] {
        let error = histogram_file::single(Path::new(path)).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{path}: cannot read")), "{error}");
    }
}
