//! Names, scopes and units in converted files.

use std::fs;

use crate::common::{self, stdout};

use super::{cells, convert, of_fst, tool};

#[test]
fn dots_in_escaped_names_are_no_scopes() {
    let folder = common::empty();
    let folder = folder.path();
    let declared = "$scope module top $end\n$scope module \\a.b $end\n\
        $var wire 1 ! \\c.d $end\n$var wire 4 # n [3:0] $end\n$upscope $end\n$upscope $end\n";
    let head = format!("$timescale 1 ns $end\n{declared}$enddefinitions $end\n");
    fs::write(folder.join("a.vcd"), format!("{head}#0\n1!\nb101 #\n#5\n0!\n#9\n")).unwrap();
    convert(folder, "a.vcd", "a.fst");
    for from in ["a.vcd", "a.fst"] {
        convert(folder, from, "b.vcd");
        let text = fs::read_to_string(folder.join("b.vcd")).unwrap();
        let lines = |text: &str| -> Vec<String> {
            let kept = text.lines().filter(|line| line.contains("scope"));
            let names = text.lines().filter(|line| line.starts_with("$var"));
            let name = |line: &str| line.split_once(['!', '#', '"']).unwrap().1.to_owned();
            kept.map(str::to_owned).chain(names.map(name)).collect()
        };
        assert_eq!(lines(&text), lines(declared), "{from}");
        let info = common::json(folder, &["wave", "info", from, "--json"]);
        assert_eq!((&info["scopes"], &info["names"]), (&2.into(), &2.into()), "{from}");
    }
}

#[test]
fn parts_of_an_array_have_their_indices_in_their_names() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = "$timescale 1 ns $end\n$scope module t $end\n$var real 64 r level [0] $end\n\
        $var real 64 q level [1] $end\n$var wire 4 a up [0:3] $end\n$var wire 4 b up [4:7] $end\n\
        $upscope $end\n$enddefinitions $end\n#0\nr0.5 r\nr2 q\nb1 a\nb10 b\n#3\n";
    fs::write(folder.join("a.vcd"), wave).unwrap();
    convert(folder, "a.vcd", "a.csv");
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    let header = csv.lines().next().unwrap();
    assert_eq!(header, "time_ns,t.level[0],t.level[1],t.up[0:3],t.up[4:7]");
    convert(folder, "a.vcd", "b.vcd");
    let text = fs::read_to_string(folder.join("b.vcd")).unwrap();
    for name in [" level[0] $end", " level[1] $end", " up [0:3] $end", " up [4:7] $end"] {
        assert!(text.contains(name), "{name}: {text}");
    }
}

#[test]
fn times_below_a_femtosecond_are_exact() {
    let folder = common::empty();
    let folder = folder.path();
    let body: String = (0..9).map(|k| format!("#{}\n{}!\n", 5 * k, k % 2)).collect();
    let head = "$timescale 10 as $end\n$scope module t $end\n$var wire 1 ! clk $end\n\
        $upscope $end\n$enddefinitions $end\n";
    fs::write(folder.join("a.vcd"), format!("{head}{body}")).unwrap();
    let info = common::json(folder, &["wave", "info", "a.vcd", "--json"]);
    assert_eq!((&info["resolution"], &info["end"]), (&1e-5.into(), &4e-4.into()));
    let stats = common::json(folder, &["wave", "stats", "a.vcd", "--json"]);
    let clk = &stats["signals"][0];
    assert_eq!((&clk["frequency_hz"], &clk["high"]["mean"]), (&1e16.into(), &5e-5.into()));
    let text = stdout(folder, &["wave", "info", "a.vcd"]);
    assert!(text.contains("0.0000004 ns") && text.contains("0.00001 ps"), "{text}");
    convert(folder, "a.vcd", "a.csv");
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    assert!(csv.starts_with("time_as,t.clk\n0,0\n50,1\n"), "{csv}");
}

#[test]
fn many_signals_are_the_same_in_fst_and_back() {
    let folder = common::empty();
    let folder = folder.path();
    let mut text = "$timescale 1 ns $end\n$scope module t $end\n".to_owned();
    (0..20_000).for_each(|k| text += &format!("$var wire 3 c{k} s{k} $end\n"));
    text += "$upscope $end\n$enddefinitions $end\n";
    for at in 0..200u64 {
        text += &format!("#{at}\n");
        let changes = (0..400).map(|k| (at * 7919 + k * 53) % 20_000);
        changes.for_each(|k| text += &format!("b{:b} c{k}\n", (at + k) % 8));
    }
    fs::write(folder.join("a.vcd"), &text).unwrap();
    convert(folder, "a.vcd", "a.fst");
    convert(folder, "a.fst", "b.vcd");
    let expected = cells(&text);
    assert_eq!(expected.len(), 20_000);
    assert!(super::read(folder, "b.vcd") == expected);
    // GTKWave's tool writes what has no value as unknown.
    let of_tool = |mut cells: super::Cells| {
        cells.values_mut().for_each(|changes| changes.retain(|(_, value)| value != "xxx"));
        cells
    };
    assert!(of_tool(of_fst(folder, "a.fst")) == expected);
    tool(folder, &["vcd2fst", "a.vcd", "theirs.fst"]);
    let [own, theirs] =
        ["a.fst", "theirs.fst"].map(|name| fs::metadata(folder.join(name)).unwrap().len());
    assert!(own < 2 * theirs, "{own} bytes, GTKWave's {theirs}");
}
