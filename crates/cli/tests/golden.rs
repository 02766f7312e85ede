//! Snapshots of the program's output. After an intended change, run `INSTA_UPDATE=always cargo test -p tofsim-cli
//! --test cli golden`, and read the difference before committing it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use wellen::simple::read;

use crate::common;

/// Length of the waveform shown: one shot from its reset to its code [ps].
const SPAN_PS: u64 = 96_000;

/// The first shot of kc705 as text: one character for each nanosecond, `▔` high and `▁` low; words
/// at the cycle in which they change.
fn ascii_wave(path: &Path) -> String {
    const BITS: [&str; 9] = [
        "clk_sys",
        "clk_laser",
        "pre_start",
        "spad_rst",
        "vcsel_driver.laser_pulse",
        "laser_on_lvds_p",
        "start",
        "tdc_stop",
        "tdc.tdc_latch.hit",
    ];
    const WORDS: [&str; 3] = ["tdc.coarse_counter.coarse", "tdc.tdc_decoder.n", "tdc_code"];
    let mut waveform = read(path).unwrap();
    let times = waveform.time_table().to_vec();
    let hierarchy = waveform.hierarchy();
    let vars: BTreeMap<_, _> = (hierarchy.all_vars())
        .map(|var| (hierarchy[var].full_name(hierarchy), hierarchy[var].signal_ref()))
        .collect();
    waveform.load_signals(&vars.values().copied().collect::<Vec<_>>());
    let changes = |name: &str| -> Vec<(u64, String)> {
        let signal = waveform.get_signal(vars[&format!("tof_top.{name}")]).unwrap();
        let changes = signal.iter_changes();
        changes.map(|(k, value)| (times[k as usize], value.to_bit_string().unwrap())).collect()
    };
    let (from, to) = (times[1], times[1] + SPAN_PS);
    let mut text = format!("from {} ns, 1 ns a character\n", from / 1000);
    for name in BITS {
        let changes = changes(name);
        write!(text, "{name:>26} ").unwrap();
        for ps in (from..to).step_by(1000) {
            let value =
                changes.iter().rev().find(|(at, _)| *at <= ps).map_or("x", |(_, bits)| bits);
            text.push(if value == "1" { '▔' } else { '▁' });
        }
        text.push('\n');
    }
    for name in WORDS {
        let words = changes(name).into_iter().filter(|(at, _)| (from..to).contains(at));
        let word = |(at, bits): (u64, String)| {
            format!("{}@{}", u64::from_str_radix(&bits, 2).unwrap(), (at - from) / 1000)
        };
        let words: Vec<_> = words.map(word).collect();
        writeln!(text, "{name:>26} {}", words.join(" ")).unwrap();
    }
    text
}

/// FNV-1a of 64 bits.
fn hash(bytes: &[u8]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ *byte as u64).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

#[test]
fn one_shot_as_a_wave_and_the_whole_file_by_its_hash() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["run", "-o", ".", "--window", "shot:0..2", "-q"];
    common::stdout(folder.path(), &args);
    let path = folder.path().join("kc705.vcd");
    let hash = hash(&fs::read(&path).unwrap());
    insta::assert_snapshot!(format!("{}whole file {hash:016x}", ascii_wave(&path)));
}

#[test]
fn the_table_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let table = common::stdout(folder.path(), &["run", "--waves", "none"]);
    let (results, _speed) = table.split_once("\n\n180,544 cycles in").unwrap();
    insta::assert_snapshot!(results);
}

#[test]
fn the_tables_of_a_budget_and_of_the_tdc_validation() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("budget", common::stdout(folder.path(), &["budget"]));
    let tdc = common::stdout(folder.path(), &["run", "tdc_validation", "--waves", "none"]);
    let (_, tdc) = tdc.split_once("per second\n").unwrap();
    insta::assert_snapshot!("table_6_3", tdc);
}

#[test]
fn a_scenario_in_full() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(common::stdout(
        folder.path(),
        &["scenario", "show", "spad_validation"]
    ));
}
