//! Conversion there and back is the identity on values.

use std::fmt::Write;
use std::fs;

use crate::common::{self, stdout};

use super::{Cells, convert, of_fst, read, same, through_gtkwave};

/// Numbers that look random.
struct Draws(u64);

impl Draws {
    fn below(&mut self, most: u64) -> u64 {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (self.0 >> 33) % most
    }
}

/// A VCD with `steps` instants of signals of all types and widths.
fn all_types(seed: u64, steps: u64) -> String {
    const WIDTHS: [u64; 12] = [1, 2, 7, 8, 9, 31, 63, 64, 65, 127, 129, 300];
    let mut text = "$timescale 10 ps $end\n$scope module top $end\n".to_owned();
    for (k, width) in WIDTHS.iter().enumerate() {
        let range = if k % 3 == 0 { String::new() } else { format!(" [{}:0]", width - 1) };
        writeln!(text, "$var wire {width} b{k} bits{width}{range} $end").unwrap();
    }
    text += "$scope module inner $end\n$var wire 7 b2 alias [6:0] $end\n$upscope $end\n\
        $var reg 4 up ascends [0:3] $end\n$var wire 1 i5 single [5] $end\n\
        $var real 64 r real $end\n$var string 1 s text $end\n$var event 1 e event $end\n\
        $upscope $end\n$enddefinitions $end\n";
    const REALS: [&str; 9] =
        ["0.1", "-1e300", "5e-324", "inf", "-inf", "3", "0.30000000000000004", "nan", "-nan"];
    const TEXTS: [&str; 7] = ["idle", "Run", "\\040", "a\\\\b", "", "→", "\\303\\251"];
    let (mut draws, mut at) = (Draws(seed), draws_of(seed));
    for _ in 0..steps {
        writeln!(text, "#{at}").unwrap();
        for (k, &width) in WIDTHS.iter().enumerate() {
            if draws.below(2) == 0 {
                let digits = if draws.below(3) == 0 { "01xz" } else { "01" };
                let count = 1 + draws.below(width);
                let digit = |_| digits.as_bytes()[draws.below(digits.len() as u64) as usize];
                let value: Vec<u8> = (0..count).map(digit).collect();
                let value = String::from_utf8(value).unwrap();
                let (b, space) = if width == 1 { ("", "") } else { ("b", " ") };
                writeln!(text, "{b}{value}{space}b{k}").unwrap();
            }
        }
        writeln!(text, "b{:04b} up\n{}i5", draws.below(16), draws.below(2)).unwrap();
        writeln!(text, "r{} r", REALS[draws.below(9) as usize]).unwrap();
        writeln!(text, "s{} s", TEXTS[draws.below(7) as usize]).unwrap();
        if draws.below(2) == 0 {
            text += "1e\n";
        }
        at += 1 + draws.below(5) * draws.below(1000);
    }
    text
}

fn draws_of(seed: u64) -> u64 {
    if seed.is_multiple_of(2) { 0 } else { 17 }
}

fn without_unknown_starts(mut cells: Cells) -> Cells {
    // GTKWave's tools write an x for what has no value yet.
    for changes in cells.values_mut() {
        let is_unknown =
            |value: &str| value.starts_with('x') && value.chars().all(|level| level == 'x');
        while changes.first().is_some_and(|(_, value)| is_unknown(value)) {
            changes.remove(0);
        }
    }
    cells.retain(|_, changes| !changes.is_empty());
    cells
}

#[test]
fn values_of_all_types_are_the_same_there_and_back() {
    let folder = common::empty();
    let folder = folder.path();
    for (seed, steps) in [(1, 40), (2, 1), (3, 400), (4, 2)] {
        fs::write(folder.join("a.vcd"), all_types(seed, steps)).unwrap();
        convert(folder, "a.vcd", "b.fst");
        convert(folder, "b.fst", "c.vcd");
        convert(folder, "c.vcd", "d.fst");
        let original = without_unknown_starts(read(folder, "a.vcd"));
        assert!(steps < 9 || original.len() == 18, "{:?}", original.keys());
        assert_eq!(without_unknown_starts(read(folder, "c.vcd")), original, "seed {seed}");
        for (text, fst) in [("a.vcd", "b.fst"), ("c.vcd", "d.fst")] {
            let ours = without_unknown_starts(of_fst(folder, fst));
            let theirs = without_unknown_starts(through_gtkwave(folder, text));
            assert_eq!(ours, theirs, "seed {seed}, {fst}");
        }
        let names = 17;
        same(folder, "a.vcd", "b.fst", names);
        same(folder, "a.vcd", "c.vcd", names);
        same(folder, "c.vcd", "d.fst", names);
    }
}

#[test]
fn what_is_converted_again_is_the_same_byte_by_byte() {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("a.vcd"), all_types(5, 300)).unwrap();
    convert(folder, "a.vcd", "b.fst");
    convert(folder, "b.fst", "c.vcd");
    convert(folder, "c.vcd", "b.fst");
    convert(folder, "b.fst", "d.vcd");
    let of = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert_eq!(of("c.vcd"), of("d.vcd"));
    assert!(of("c.vcd").contains("$timescale 10 ps $end"));
    assert!(of("c.vcd").contains(" ascends [0:3] $end"), "{}", &of("c.vcd")[..900]);
}

#[test]
fn a_csv_has_a_row_for_each_instant() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = "$timescale 100 fs $end\n$scope module t $end\n$var wire 1 ! clk $end\n\
        $var wire 8 # n [7:0] $end\n$var real 64 r level $end\n$var string 1 s state $end\n\
        $var event 1 e e $end\n$var wire 80 w wide $end\n\
        $upscope $end\n$enddefinitions $end\n#0\n0!\n#5\n1!\nb101 #\nsidle s\n1e\n\
        #9\nbx1 #\nr0.5 r\n#10\nb11 w\nbz #\n#12\n";
    fs::write(folder.join("a.vcd"), wave).unwrap();
    convert(folder, "a.vcd", "a.csv");
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    let expected = "time_fs,t.clk,t.n,t.level,t.state,t.e,t.wide\n\
        0,0,,,,,\n500,1,5,,idle,1,\n900,1,0bxxxxxxx1,0.5,idle,,\n\
        1000,1,0bzzzzzzzz,0.5,idle,,0x3\n1200,1,0bzzzzzzzz,0.5,idle,,0x3\n";
    assert_eq!(csv, expected);
}

#[test]
fn wavejson_has_a_brick_for_each_instant() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = "$timescale 1 ps $end\n$scope module t $end\n$var wire 1 ! clk $end\n\
        $var wire 8 # n [7:0] $end\n$var event 1 e e $end\n$upscope $end\n$enddefinitions $end\n\
        #0\n0!\n#5\n1!\nb101 #\n1e\n#9\nbx #\n0!\n#10\nb11 #\n#11\nb100 #\n#12\n";
    fs::write(folder.join("a.vcd"), wave).unwrap();
    convert(folder, "a.vcd", "a.json");
    let json = fs::read_to_string(folder.join("a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let lanes = [
        serde_json::json!({ "name": "time [ps]", "wave": "======",
            "data": ["0", "5", "9", "10", "11", "12"] }),
        serde_json::json!({ "name": "t.clk", "wave": "010..." }),
        serde_json::json!({ "name": "t.n", "wave": "x=x==.", "data": ["5", "3", "4"] }),
        serde_json::json!({ "name": "t.e", "wave": "010..." }),
    ];
    assert_eq!(json["signal"], serde_json::Value::from(lanes.to_vec()));
}

#[test]
fn info_counts_what_a_file_has() {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("a.vcd"), all_types(1, 40)).unwrap();
    convert(folder, "a.vcd", "a.fst");
    let [vcd, fst] =
        ["a.vcd", "a.fst"].map(|name| common::json(folder, &["wave", "info", name, "--json"]));
    assert_eq!(vcd["schema"], "tofsim.wave_info/1");
    for key in
        ["unit", "resolution", "end", "scopes", "names", "different_signals", "bits", "types"]
    {
        assert_eq!(vcd[key], fst[key], "{key}");
    }
    assert_eq!((&vcd["names"], &vcd["different_signals"]), (&18.into(), &17.into()));
    assert_eq!(vcd["bits"], 1 + 2 + 7 + 8 + 9 + 31 + 63 + 64 + 65 + 127 + 129 + 300 + 4 + 1);
    assert_eq!(vcd["resolution"], 10.0);
    let text = stdout(folder, &["wave", "info", "a.fst", "-v"]);
    assert!(text.contains("top.ascends [0:3]"), "{text}");
}
