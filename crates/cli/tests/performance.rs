//! `docs/performance.md` has the figures of `docs/peers.json`, which `benches/peers --json` prints.
//!
//! `UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli performance` writes them anew.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
const BEGIN: &str = "<!-- peers -->\n";
const END: &str = "<!-- end -->";

/// Kinds of work, and their names on the page.
const WORK: [(&str, &str); 6] = [
    ("cycle", "plain step, every cycle"),
    ("cycle_skip", "idle cycles skipped"),
    ("shot", "`--fidelity shot`"),
    ("histogram", "`--fidelity histogram`, budget cached"),
    ("vcd", "VCD of every signal, to `/dev/null`"),
    ("fst", "FST of every signal"),
];
const LASER_FREQS: [u64; 2] = [3, 0];

/// Formats three significant digits.
fn digits(value: &Value) -> String {
    let value = value.as_f64().unwrap();
    let decimals = (2.0 - value.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// Returns the member of a list that has such a work and laser rate, or several.
fn of<'a>(list: &'a Value, work: &'a str, laser_freq: u64) -> impl Iterator<Item = &'a Value> + 'a {
    let all = list.as_array().unwrap().iter();
    all.filter(move |one| one["work"] == work && one["laser_freq"] == laser_freq)
}

fn page_of(record: &Value) -> String {
    let version = |tool: &str| record["versions"][tool].as_str().unwrap();
    let mut page = format!(
        "Medians of one run, {} ({}); {}, {}, {}, {}:\n\n",
        record["pinned"].as_str().unwrap(),
        record["cpu"].as_str().unwrap(),
        version("verilator").split(" rev").next().unwrap(),
        version("iverilog").split(" (").next().unwrap(),
        version("g++"),
        version("rustc").split(" (").next().unwrap(),
    );
    page +=
        "| work [ms a frame] | laser_freq | tofsim | Verilator | ratio |\n|---|---|---|---|---|\n";
    for laser_freq in LASER_FREQS {
        for (work, name) in WORK {
            let row = of(&record["rows"], work, laser_freq).next().unwrap();
            let [ours, theirs, ratio] =
                ["tofsim_ms", "verilator_ms", "ratio"].map(|what| digits(&row[what]));
            writeln!(page, "| {name} | {laser_freq} | {ours} | {theirs} | {ratio} |").unwrap();
        }
    }
    page += "\n| peer [ms a frame] | laser_freq 3 | laser_freq 0 |\n|---|---|---|\n";
    for (work, _) in WORK {
        let [fast, slow] = LASER_FREQS.map(|laser_freq| of(&record["peers"], work, laser_freq));
        for (fast, slow) in fast.zip(slow) {
            let [simulator, variant] =
                ["simulator", "variant"].map(|what| fast[what].as_str().unwrap());
            let shots = fast["shots"].as_u64().unwrap();
            let scaled =
                if shots == 30_000 { "" } else { &*format!(", frames of {shots} shots, scaled") };
            let [fast, slow] = [fast, slow].map(|peer| digits(&peer["ms"]));
            writeln!(page, "| {simulator}: {variant}{scaled} | {fast} | {slow} |").unwrap();
        }
    }
    page
}

#[test]
fn the_page_has_what_was_measured() {
    let path = Path::new(DOCS).join("performance.md");
    let record = fs::read_to_string(Path::new(DOCS).join("peers.json")).unwrap();
    let record = serde_json::from_str(&record).unwrap();
    let page = fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let new = format!("{before}{BEGIN}{}{END}{after}", page_of(&record));
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &new).unwrap();
    }
    let how = "UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli performance";
    assert!(page == new, "docs/performance.md is out of date: {how}");
}
