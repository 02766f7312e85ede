//! Values of all types, across formats.

mod late;

use std::fs;

use crate::common;

use super::{different, differing, refused, same, write};

/// A waveform in VHDL of GHDL's, in two formats.
const VHDL: &str = "entity types is end;
architecture a of types is
  type state is (Idle, Run, 'x', Done);
  signal s: state := Idle; signal c: character := 'a'; signal b: boolean; signal t: time := 1 ns;
begin
  process begin
    wait for 1 ns; s <= Run; c <= 'Z'; b <= true; t <= 5 us;
    wait for 1 ns; s <= 'x'; c <= ' '; b <= false;
    wait for 1 ns; s <= Done; c <= nul; wait;
  end process;
end;
";

fn events(times: &[u64]) -> String {
    let head = "$timescale 1 ns $end\n$scope module top $end\n$var event 1 e done $end\n\
        $var wire 1 c clk $end\n$upscope $end\n$enddefinitions $end\n";
    (0..40).fold(head.to_owned(), |text, at| {
        let event = if times.contains(&at) { "1e\n" } else { "" };
        text + &format!("#{at}\n{}c\n{event}", at % 2)
    })
}

#[test]
fn events_are_compared_by_when_they_occur() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &events(&[3, 9, 20]));
    write(folder, "b.vcd", &events(&[3, 9, 20]));
    write(folder, "late.vcd", &events(&[3, 10, 20]));
    let json = same(folder, &["a.vcd", "b.vcd", "--strict"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
    let json = different(folder, &["a.vcd", "late.vcd"]);
    assert_eq!(differing(&json), ["top.done"]);
    let first = &json["first"]["first"];
    assert_eq!((&first["expected"], &first["got"]), (&"1".into(), &"0".into()));
    assert_eq!(first["at"].to_string(), "[9000.0,9000.0]");
    // What follows occurs on both sides.
    assert_eq!(json["first"]["differing"], 2);
    same(folder, &["a.vcd", "late.vcd", "--after", "15ns", "--strict"]);
    same(folder, &["a.vcd", "late.vcd", "--until", "9ns", "--strict"]);
}

#[test]
fn an_event_belongs_to_the_sample_after_it() {
    let folder = common::empty();
    let folder = folder.path();
    // The clock rises at odd times; what occurs with an edge is of the next sample.
    write(folder, "a.vcd", &events(&[3, 9, 20]));
    write(folder, "same.vcd", &events(&[4, 10, 19]));
    write(folder, "late.vcd", &events(&[3, 11, 20]));
    let clock = ["--clock", "top.clk"];
    same(folder, &[&["a.vcd", "same.vcd"][..], &clock].concat());
    let json = different(folder, &[&["a.vcd", "late.vcd"][..], &clock].concat());
    assert_eq!(differing(&json), ["top.done"]);
    assert_eq!(json["first"]["differing"], 2);
}

#[test]
fn events_are_pulses_in_the_waveform_of_both_sides() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &events(&[3, 9, 20]));
    write(folder, "b.vcd", &events(&[3, 10, 20]));
    different(folder, &["a.vcd", "b.vcd", "--waves", "both.vcd"]);
    let json = common::json(folder, &["wave", "stats", "both.vcd", "--signals", "*done", "--json"]);
    let high = json["signals"].as_array().unwrap().iter().map(|signal| &signal["high"]["count"]);
    let names: Vec<_> = json["signals"].as_array().unwrap().iter().map(|s| &s["name"]).collect();
    // Each occurs three times, and they differ twice, at 9 ns and the next instant.
    assert_eq!(high.collect::<Vec<_>>(), [3, 3, 1], "{names:?}");
}

/// A VCD with an enumeration whose names have the given values, and their changes.
fn states(width: u32, names: [(&str, u64); 3], order: &[usize]) -> String {
    let words: String = names.iter().map(|(name, _)| format!(" {name}")).collect();
    let values: String =
        names.iter().map(|(_, value)| format!(" {value:0w$b}", w = width as usize)).collect();
    let mut text = format!(
        "$timescale 1 ns $end\n$scope module top $end\n$attrbegin misc 07 t 3{words}{values} 1 \
         $end\n$attrbegin misc 07 \"\" 1 $end\n$var wire {width} s state $end\n$upscope $end\n\
         $enddefinitions $end\n"
    );
    for (at, &place) in order.iter().enumerate() {
        text += &format!("#{at}\nb{:b} s\n", names[place].1);
    }
    text + "#9\n"
}

#[test]
fn enumerations_with_other_values_are_compared_by_name() {
    let folder = common::empty();
    let folder = folder.path();
    let binary = [("Idle", 0), ("Run", 1), ("Done", 2)];
    let one_hot = [("idle", 1), ("done", 4), ("run", 2)];
    write(folder, "a.vcd", &states(2, binary, &[0, 1, 2, 0]));
    write(folder, "b.vcd", &states(3, one_hot, &[0, 2, 1, 0]));
    write(folder, "c.vcd", &states(3, one_hot, &[0, 1, 1, 0]));
    same(folder, &["a.vcd", "b.vcd", "--strict"]);
    let json = different(folder, &["a.vcd", "c.vcd"]);
    assert_eq!(json["first"]["first"]["at"].to_string(), "[1000.0,1000.0]");
    assert_eq!(json["first"]["differing"], 1);
    // In FST the names are tables.
    common::stdout(folder, &["wave", "convert", "b.vcd", "-o", "b.fst"]);
    same(folder, &["a.vcd", "b.fst", "--strict"]);
    same(folder, &["b.fst", "a.vcd"]);
}

#[test]
fn a_state_that_the_other_side_does_not_have_is_another_value() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &states(2, [("Idle", 0), ("Run", 1), ("Done", 2)], &[0, 1, 2, 0]));
    let other = [("idle", 1), ("done", 4), ("halt", 2)];
    write(folder, "b.vcd", &states(3, other, &[0, 2, 1, 0]));
    for unknowns in ["exact", "any", "none"] {
        let json = different(folder, &["a.vcd", "b.vcd", "--x", unknowns]);
        let first = &json["first"];
        assert_eq!(first["differing"], 1, "{unknowns}");
        let values = [&first["first"]["expected"], &first["first"]["got"]];
        assert_eq!(values, ["Run (1)", "halt (2)"], "{unknowns}");
    }
    // Equal encodings are compared as they are, whatever names are missing.
    let more = [("Idle", 0), ("Run", 1), ("Halt", 3)];
    write(folder, "c.vcd", &states(2, more, &[0, 1, 0, 0]));
    write(folder, "d.vcd", &states(2, [("Idle", 0), ("Run", 1), ("Done", 2)], &[0, 1, 0, 0]));
    same(folder, &["c.vcd", "d.vcd", "--strict"]);
}

#[test]
fn names_are_matched_exactly_before_their_case_is_ignored() {
    let folder = common::empty();
    let folder = folder.path();
    let both = [("Run", 0), ("run", 1), ("idle", 2)];
    write(folder, "a.vcd", &states(2, both, &[0, 1, 2, 0]));
    write(folder, "b.vcd", &states(2, [("run", 0), ("Run", 1), ("IDLE", 3)], &[1, 0, 2, 1]));
    same(folder, &["a.vcd", "b.vcd", "--strict"]);
    // Neither `Run` nor `run` is RUN, and '1' is not 'l'.
    write(folder, "c.vcd", &states(2, [("RUN", 0), ("x", 1), ("idle", 3)], &[0, 0, 2, 0]));
    let json = different(folder, &["a.vcd", "c.vcd"]);
    assert_eq!(json["first"]["differing"], 3);
    write(folder, "d.vcd", &states(2, [("'z'", 0), ("'x'", 1), ("idle", 2)], &[0, 1, 2, 0]));
    write(folder, "e.vcd", &states(2, [("'Z'", 0), ("'x'", 3), ("idle", 2)], &[0, 1, 2, 0]));
    let json = different(folder, &["d.vcd", "e.vcd"]);
    assert_eq!(json["first"]["first"]["got"], "'Z' (0)");
    assert_eq!(json["first"]["differing"], 2);
}

#[test]
fn bits_of_an_enumeration_are_compared_by_value() {
    let folder = common::empty();
    let folder = folder.path();
    let binary = [("Idle", 0), ("Run", 1), ("Done", 2)];
    write(folder, "a.vcd", &states(2, binary, &[0, 1, 2, 0]));
    write(folder, "b.vcd", &states(3, [("idle", 4), ("run", 1), ("done", 2)], &[0, 1, 2, 0]));
    write(folder, "map.toml", "[[signal]]\na = [\"top.state[0:0]\"]\nb = [\"top.state[0:0]\"]\n");
    same(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
    let map = "[[signal]]\na = [\"top.state\"]\nb = [\"top.state\"]\n";
    write(folder, "map.toml", map);
    same(folder, &["a.vcd", "b.vcd", "--map", "map.toml", "--strict"]);
    write(folder, "map.toml", &format!("{map}dont_care = \"0x2\"\n"));
    same(folder, &["a.vcd", "b.vcd", "--map", "map.toml", "--strict"]);
    write(folder, "map.toml", &format!("{map}dont_care = \"0x4\"\n"));
    let error = refused(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
    assert!(error.contains("2 bits at most"), "{error}");
}

#[test]
fn ghdl_s_words_in_fst_are_its_enumerations_in_ghw() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "types.vhd", VHDL);
    let ghdl = |words: &[&str]| {
        let output = std::process::Command::new("ghdl").current_dir(folder).args(words).output();
        assert!(output.unwrap().status.success(), "ghdl {words:?}: see CONTRIBUTING.md");
    };
    ghdl(&["-a", "types.vhd"]);
    ghdl(&["-e", "types"]);
    ghdl(&["-r", "types", "--fst=t.fst", "--wave=t.ghw", "--vcd=t.vcd"]);
    let json = same(folder, &["t.ghw", "t.fst", "--strict"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 3, "{json:#}");
    same(folder, &["t.ghw", "t.ghw", "--strict"]);
    // Text that GTKWave's tool has escaped is the same text.
    let text = std::process::Command::new("fst2vcd").current_dir(folder).arg("t.fst").output();
    fs::write(folder.join("own.vcd"), text.unwrap().stdout).unwrap();
    same(folder, &["t.fst", "own.vcd", "--strict"]);
    same(folder, &["t.ghw", "own.vcd", "--strict"]);
    same(folder, &["t.ghw", "t.vcd"]);
}

#[test]
fn what_cannot_be_compared_is_listed_and_refused_if_asked() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = |kind: &str, width: u32, value: &str| {
        format!(
            "$timescale 1 ns $end\n$scope module top $end\n$var wire 1 c clk $end\n\
             $var {kind} {width} n value $end\n$upscope $end\n$enddefinitions $end\n\
             #0\n1c\n{value} n\n#5\n0c\n#9\n"
        )
    };
    write(folder, "bits.vcd", &wave("wire", 8, "b101"));
    write(folder, "wide.vcd", &wave("wire", 9, "b101"));
    write(folder, "real.vcd", &wave("real", 64, "r5"));
    write(folder, "text.vcd", &wave("string", 1, "sfive"));
    let cases = [
        ("wide.vcd", "8 bits here, 9 on the other side"),
        ("real.vcd", "bits here, real numbers on the other side"),
        ("text.vcd", "top.value is not compared because its words are `five`"),
    ];
    for (other, reason) in cases {
        let json = same(folder, &["bits.vcd", other]);
        assert!(json["skipped"].to_string().contains(reason), "{other}: {}", json["skipped"]);
        let error = refused(folder, &["bits.vcd", other, "--strict"]);
        assert!(error.contains("--strict: expected that all values can be compared"), "{error}");
    }
    same(folder, &["bits.vcd", "bits.vcd", "--strict"]);
    assert_eq!(
        same(folder, &["real.vcd", "real.vcd", "--strict"])["skipped"],
        serde_json::json!([])
    );
}
