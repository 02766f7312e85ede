//! Waveforms against each other, change by change.

use std::fs;
use std::path::Path;

use crate::common;

use super::{different, differing, refused, same, vcd, write};

/// A clock and a count, in steps of 5 ns; the count at step 7 is `seventh`.
pub fn counting(timescale: &str, scale: u64, scope: &str, seventh: u64) -> String {
    let mut body = String::new();
    for step in 0..20u64 {
        let count = if step == 7 { seventh } else { step };
        body += &format!("#{}\n{}a\n", step * scale, step % 2);
        if step % 2 == 1 {
            body += &format!("b{count:b} b\n");
        }
    }
    vcd(timescale, scope, &[(1, "clk"), (8, "count [7:0]")], &body)
}

#[test]
fn a_different_value_is_found_at_its_time() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    same(folder, &["a.vcd", "a.vcd"]);
    let json = different(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(differing(&json), ["top.count"]);
    let first = &json["first"]["first"];
    assert_eq!(first["at"].to_string(), "[35000.0,35000.0]");
    assert_eq!((&first["expected"], &first["got"]), (&"0x07".into(), &"0x27".into()));
    assert_eq!(first["bits"].to_string(), "[5]");
    assert_eq!(json["first"]["differing"], 1);
}

#[test]
fn both_sides_are_brought_to_the_coarser_timescale() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "ns.vcd", &counting("1 ns", 5, "top", 7));
    write(folder, "fs.vcd", &counting("100 fs", 50_003, "top", 7));
    write(folder, "late.vcd", &counting("100 fs", 60_003, "top", 7));
    same(folder, &["ns.vcd", "fs.vcd"]);
    same(folder, &["fs.vcd", "ns.vcd"]);
    different(folder, &["ns.vcd", "late.vcd"]);
}

#[test]
fn a_design_is_found_wherever_it_hangs() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "bench $end\n$scope module dut", 7));
    let json = same(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(json["signals"][0]["matched_by"], "suffix");
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
}

#[test]
fn a_side_that_ends_early_is_different_unless_asked_not_to_look() {
    let folder = common::empty();
    let folder = folder.path();
    let whole = counting("1ns", 5, "top", 7);
    write(folder, "a.vcd", &whole);
    write(folder, "b.vcd", whole.split_once("#60\n").unwrap().0);
    let json = different(folder, &["a.vcd", "b.vcd"]);
    assert!(json["differences"].to_string().contains("ends at 95 ns, the second at 55 ns"));
    assert!(differing(&json).is_empty());
    same(folder, &["a.vcd", "b.vcd", "--until", "55ns"]);
}

#[test]
fn the_last_value_of_a_file_is_compared() {
    let folder = common::empty();
    let folder = folder.path();
    let body = |last: u8| format!("#0\nb1 a\n#10\nb10 a\n#20\nb{last:b} a\n");
    write(folder, "a.vcd", &vcd("1ps", "top", &[(8, "x")], &body(3)));
    write(folder, "b.vcd", &vcd("1ps", "top", &[(8, "x")], &body(7)));
    assert_eq!(differing(&different(folder, &["a.vcd", "b.vcd"])), ["top.x"]);
}

#[test]
fn the_last_instant_counts_unless_one_side_has_nothing_there() {
    let folder = common::empty();
    let folder = folder.path();
    let variables = [(1, "clk"), (8, "x")];
    let wave = |last: &str| vcd("1ps", "top", &variables, &format!("#0\n0a\nb1 b\n#20\n{last}"));
    write(folder, "a.vcd", &wave("1a\nb11 b\n"));
    write(folder, "b.vcd", &wave("1a\n"));
    write(folder, "end.vcd", &wave(""));
    assert_eq!(differing(&different(folder, &["a.vcd", "b.vcd"])), ["top.x"]);
    same(folder, &["a.vcd", "end.vcd"]);
    same(folder, &["end.vcd", "a.vcd"]);
}

#[test]
fn a_shift_in_time_or_by_an_edge_is_taken_out() {
    let folder = common::empty();
    let folder = folder.path();
    let body = |late: u64| format!("#0\n0a\nb1 b\n#{}\n1a\nb10 b\n#{}\n0a\n", 10 + late, 30 + late);
    let variables = [(1, "go"), (4, "x")];
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, &body(0)));
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, &body(7)));
    different(folder, &["a.vcd", "b.vcd"]);
    let args = ["a.vcd", "b.vcd", "--after", "5ns"];
    same(folder, &[&args[..], &["--align", "offset 7ns"]].concat());
    same(folder, &[&args[..], &["--align", "edge go"]].concat());
    same(folder, &["b.vcd", "a.vcd", "--after", "12ns", "--align", "offset -7ns"]);
    let error = refused(folder, &[&args[..], &["--align", "edge y"]].concat());
    assert!(error.contains("y: no such signal"), "{error}");
    let error = refused(folder, &[&args[..], &["--align", "trigger"]].concat());
    assert!(error.contains("--clock"), "{error}");
}

#[test]
fn bytes_of_an_fst_that_look_like_a_time_stamp_are_none() {
    let folder = common::empty();
    let folder = folder.path();
    for format in ["vcd", "fst"] {
        let frame = ["-s", "firmware.shots_per_frame=1000", "--window", "0us..50us", "-o", "."];
        common::stdout(folder, &[&["run", "--waves", format], &frame[..]].concat());
    }
    let bytes = fs::read(folder.join("kc705.fst")).unwrap();
    let looks_so = |bytes: &[u8]| bytes.starts_with(b"\n#") && !bytes[2].is_ascii_digit();
    assert!(bytes.windows(3).any(looks_so));
    same(folder, &["kc705.vcd", "kc705.fst"]);
}

#[test]
fn vcd_and_fst_of_one_run_are_the_same() {
    let folder = common::empty();
    let folder = folder.path();
    for format in ["vcd", "fst"] {
        let args = common::short_run(&["--waves", format, "-o", "."]);
        common::stdout(folder, &args);
    }
    let json = same(folder, &["kc705.vcd", "kc705.fst"]);
    assert!(json["signals"].as_array().unwrap().len() > 90, "{json:#}");
    same(folder, &["kc705.vcd", "kc705.fst", "--clock", "tof_top.clk_sys"]);
    same(
        folder,
        &[
            "--scenario",
            "kc705",
            "-s",
            "firmware.shots_per_frame=40",
            "kc705.fst",
            "--after",
            "3.2us",
            "--until",
            "3.5us",
        ],
    );
}

#[test]
fn what_differs_first_stands_first_in_the_order_of_data_flow() {
    let folder = common::empty();
    let folder = folder.path();
    let args = |seed| common::short_run(&["--seed", seed, "-o", seed]);
    common::stdout(folder, &args("1"));
    common::stdout(folder, &args("2"));
    let json = different(folder, &["1/kc705.vcd", "2/kc705.vcd"]);
    let names = differing(&json);
    assert_eq!(names[0], "tof_top.tdc_stop");
    let place = |name: &str| names.iter().position(|other| other == name).unwrap();
    assert!(place("tof_top.tdc.carry_chain.taps") < place("tof_top.tdc.tdc_latch.hit_taps"));
    assert!(place("tof_top.tdc.tdc_decoder.n") < place("tof_top.depth"));
}

#[test]
fn what_differs_at_once_stands_in_the_order_of_data_flow() {
    let folder = common::empty();
    let folder = folder.path();
    let names = ["depth_estimator.forward2.depth", "tdc.tdc_decoder.n", "frame_ctrl.state", "x.y"];
    let variables = names.map(|name| (4, name));
    let wave = |value: u8| {
        let values: String = ('a'..'e').map(|id| format!("b{value:b} {id}\n")).collect();
        vcd("1ns", "tof_top", &variables, &format!("#0\nb0 a\nb0 b\nb0 c\nb0 d\n#5\n{values}"))
    };
    write(folder, "a.vcd", &wave(1));
    write(folder, "b.vcd", &wave(2));
    let differing = differing(&different(folder, &["a.vcd", "b.vcd"]));
    let flow = ["frame_ctrl.state", "tdc.tdc_decoder.n", "depth_estimator.forward2.depth", "x.y"];
    assert_eq!(differing, flow.map(|name| format!("tof_top.{name}")));
}

#[test]
fn both_sides_and_what_differs_go_into_one_waveform() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    different(folder, &["a.vcd", "b.vcd", "--waves", "both.vcd"]);
    assert_eq!(common::files(folder), ["a.vcd", "b.vcd", "both.gtkw", "both.sucl", "both.vcd"]);
    let wave = fs::read_to_string(folder.join("both.vcd")).unwrap();
    for name in ["expected", "got", "differs", "top/count", "any_differs"] {
        assert!(wave.contains(name), "{name}");
    }
    same(folder, &["both.vcd", "both.vcd"]);
    let save = fs::read_to_string(folder.join("both.gtkw")).unwrap();
    assert!(save.contains("compare.differs.top/count\n"), "{save}");
    let error = refused(folder, &["a.vcd", "b.vcd", "--waves", "both.fst"]);
    assert!(error.contains("--waves: both.fst: expected a name that ends in .vcd"), "{error}");
}

#[test]
fn the_waveform_of_differences_shows_them_where_they_are() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    different(folder, &["a.vcd", "b.vcd", "--waves", "both.vcd"]);
    let changes = |name: &str| {
        let mut wave = wellen::simple::read(folder.join("both.vcd")).unwrap();
        let path: Vec<&str> = name.split('.').collect();
        let (last, scopes) = path.split_last().unwrap();
        let var = wave.hierarchy().lookup_var(scopes, last).unwrap();
        let signal = wave.hierarchy()[var].signal_ref();
        wave.load_signals(&[signal]);
        let times = wave.time_table().to_vec();
        let changes = wave.get_signal(signal).unwrap().iter_changes();
        let spelled = changes.map(|(at, value)| format!("{}:{value}", times[at as usize]));
        spelled.collect::<Vec<_>>().join(" ")
    };
    assert!(changes("compare.any_differs").ends_with("35000:1 45000:0"));
    assert!(changes("compare.got.top/count").contains("35000:00100111"));
    assert!(changes("compare.expected.top/count").contains("35000:00000111"));
}

#[test]
fn a_report_for_continuous_integration_has_a_case_for_each_signal() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    different(folder, &["a.vcd", "b.vcd", "--junit", "report.xml"]);
    let text = fs::read_to_string(folder.join("report.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let cases: Vec<_> = xml.descendants().filter(|node| node.has_tag_name("testcase")).collect();
    let failed = cases.iter().filter(|case| case.descendants().any(|n| n.has_tag_name("failure")));
    let failed: Vec<_> = failed.map(|case| case.attribute("name").unwrap()).collect();
    assert_eq!((cases.len(), failed), (3, vec!["top.count"]));
    assert!(text.contains("expected 0x07, got 0x27"), "{text}");
    write(folder, "b.vcd", counting("1ns", 5, "top", 7).split_once("#60\n").unwrap().0);
    different(folder, &["a.vcd", "b.vcd", "--junit", "report.xml"]);
    let text = fs::read_to_string(folder.join("report.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let failure = xml.descendants().find(|node| node.has_tag_name("failure")).unwrap();
    assert_eq!(failure.parent().unwrap().attribute("name"), Some("structure"));
}

#[test]
fn the_text_names_the_first_difference_and_where_they_all_lie() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    let output = common::output(folder, &["compare", "a.vcd", "b.vcd"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("first     top.count at 35 ns: expected 0x07, got 0x27"), "{text}");
    assert!(text.contains(" 1 of 10 "), "{text}");
    assert!(text.contains(".......#............"), "{text}");
}

/// Both files are GHDL's, by `ghdl -a counter.vhdl && ghdl -e counter && ghdl -r counter
/// --stop-time=200ns --wave=counter.ghw --vcd=counter.vcd`.
#[test]
fn ghdl_s_two_formats_are_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/tests/ghdl");
    let json = same(&folder, &["counter.vcd", "counter.ghw"]);
    let names: Vec<_> =
        json["signals"].as_array().unwrap().iter().map(|signal| signal["name"].clone()).collect();
    assert_eq!(names, ["counter.clk", "counter.count", "counter.bus_z"]);
    assert_eq!(json["sides"][1]["format"], "GHW");
    let last = different(&folder, &["counter.vcd", "counter.ghw", "--x", "none"]);
    assert_eq!(differing(&last), ["counter.bus_z"], "two of its bits are Z and X at first");
}

#[test]
fn a_waveform_without_a_time_scale_is_in_nanoseconds_with_a_note() {
    let folder = common::empty();
    let folder = folder.path();
    let good = counting("1ns", 5, "top", 7);
    write(folder, "good.vcd", &good);
    write(folder, "unscaled.vcd", &good.replace("$timescale 1ns $end\n", ""));
    let notes = same(folder, &["good.vcd", "unscaled.vcd"])["notes"].to_string();
    assert!(notes.contains("unscaled.vcd: has no $timescale: times are read as"), "{notes}");
}

#[test]
fn what_is_no_waveform_or_a_broken_one_is_refused() {
    let folder = common::empty();
    let folder = folder.path();
    let good = counting("1ns", 5, "top", 7);
    write(folder, "good.vcd", &good);
    let refused = |text: &str| {
        write(folder, "bad.vcd", text);
        refused(folder, &["good.vcd", "bad.vcd"])
    };
    let back = good.replace("#60\n", "#20\n");
    assert!(refused(&back).contains("bad.vcd:37:1: time goes back from 55 to 20"));
    assert!(refused("").contains("bad.vcd: is empty"));
    assert!(refused("hello\n").contains("bad.vcd:1:1: hello: expected VCD, FST, GHW"));
    assert!(refused(&good.replace("wire 8", "wire 4000000000")).contains("bits at most"));
    for (from, to) in [("b111 b", "b1q1 b"), ("b111 b", "b111111111111 b")] {
        let error = refused(&good.replacen(from, to, 1));
        assert!(error.contains("bad.vcd:26:1: "), "{from} {to}: {error}");
    }
    let remark = good.replace("#60\n", "$comment\n#0\n$end\n#60\n");
    write(folder, "remark.vcd", &remark);
    same(folder, &["good.vcd", "remark.vcd"]);
    let error = super::refused(folder, &["good.vcd", "missing.vcd"]);
    assert!(error.contains("missing.vcd: cannot read"), "{error}");
    let error = super::refused(folder, &["good.vcd", "."]);
    assert!(error.contains("expected a file"), "{error}");
    let error = super::refused(folder, &["good.vcd"]);
    assert!(error.contains("expected two files"), "{error}");
}
