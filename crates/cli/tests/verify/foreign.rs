//! Designs that are built otherwise than ours: constants inside, registers without initial values,
//! ports that mean something only at times, arrays at ports.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::{OWN, THEIRS, map};

/// A folder with our Verilog files of those names, their text changed.
fn changed(names: &[&str], change: impl Fn(&str, String) -> String) -> tempfile::TempDir {
    let folder = common::empty();
    for name in names {
        let file = format!("{name}.v");
        let text = fs::read_to_string(Path::new(OWN).join(&file)).unwrap();
        let new = change(name, text.clone());
        assert_ne!(new, text, "{name}: nothing has changed");
        fs::write(folder.path().join(file), new).unwrap();
    }
    folder
}

/// The report on a block in its default configuration.
fn check(folder: &Path, block: &str, args: &[&str]) -> Value {
    let block = format!("{block}.default");
    let all = ["verify", "--rtl", ".", "--block", &block, "--json"];
    let output = common::output(folder, &[&all[..], args].concat());
    let error = String::from_utf8(output.stderr).unwrap();
    let report: Value =
        serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{error}"));
    report["blocks"][0].clone()
}

/// Without what sets registers at power-up.
fn without_initial_values(_: &str, text: String) -> String {
    let mut rest = text.as_str();
    let mut kept = String::new();
    while let Some(begin) = rest.find("    initial ") {
        let (before, block) = rest.split_at(begin);
        let end = if block.starts_with("    initial begin") { "\n    end\n" } else { ";\n" };
        kept += before;
        rest = &block[block.find(end).unwrap() + end.len()..];
    }
    kept + rest
}

#[test]
fn registers_need_no_initial_values() {
    let names = ["coarse_counter", "control_sync", "histogram_builder", "tdc_latch", "reset_sync"];
    let folder = changed(&names, without_initial_values);
    for name in names {
        let report = check(folder.path(), name, &["--cycles", "2000"]);
        assert_eq!(report["verdict"], "pass", "{report}");
        let report = check(folder.path(), name, &["--cycles", "2000", "--from-power-up"]);
        assert_eq!(report["verdict"], "differs", "{report}");
    }
}

#[test]
fn a_wrong_reset_is_found_though_nothing_is_compared_before_it() {
    let reset = |_: &str, text: String| text.replace("window <= 1'b0;", "window <= 1'b1;");
    let folder = changed(&["coarse_counter"], reset);
    assert_eq!(check(folder.path(), "coarse_counter", &[])["first"]["cycle"], 17);
}

#[test]
fn a_pipeline_without_reset_has_its_clocks_after_each_reset() {
    let no_reset = |_: &str, text: String| {
        without_initial_values("", text).replace("if (rst) begin", "if (1'b0) begin")
    };
    let folder = changed(&["tdc_decoder"], no_reset);
    let rom = "    initial $readmemh(CalFile, cal);\n";
    let path = folder.path().join("tdc_decoder.v");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("endmodule", &format!("{rom}endmodule"), 1)).unwrap();
    let verdict = |more: &str| {
        let text = format!("[block.tdc_decoder]\n{more}");
        fs::write(folder.path().join("map.toml"), text).unwrap();
        check(folder.path(), "tdc_decoder", &["--map", "map.toml", "--cycles", "1000"])["verdict"]
            .clone()
    };
    let valid = "valid = { tdc_code = \"tdc_valid\" }\n";
    assert_eq!(verdict(valid), "differs", "the hits that were under way");
    assert_eq!(verdict("settle = 6\n"), "differs", "the code of the last hit");
    assert_eq!(verdict(&format!("settle = 6\n{valid}")), "pass");
}

#[test]
fn a_constant_inside_is_named_with_the_entry_that_leaves_it_out() {
    let constant = |_: &str, text: String| {
        let (head, rest) = text.split_once("    parameter CalFile").unwrap();
        let (rom, rest) = rest.split_once(',').unwrap();
        let (ports, body) = rest.split_once(");\n").unwrap();
        format!("{head}{ports});\n    localparam CalFile{rom};\n{body}")
    };
    let folder = changed(&["tdc_decoder"], constant);
    let error = common::refused(folder.path(), &["verify", "--rtl", ".", "--block", "tdc_decoder"]);
    assert!(error.contains("module tdc_decoder, parameter CalFile: no such parameter"), "{error}");
    assert!(error.contains("[block.tdc_decoder.parameters] CalFile = \"\""), "{error}");
    // What it has inside is what the scenario says, not the words that the stimulus would try.
    let calibration = Path::new(OWN).join("tdc_cal.mem");
    fs::create_dir(folder.path().join("rtl_ref")).unwrap();
    fs::copy(calibration, folder.path().join("rtl_ref/tdc_cal.mem")).unwrap();
    for map in
        ["[design]\nparameters = false\n", "[block.tdc_decoder.parameters]\nCalFile = \"\"\n"]
    {
        fs::write(folder.path().join("map.toml"), map).unwrap();
        let report =
            check(folder.path(), "tdc_decoder", &["--map", "map.toml", "--cycles", "1000"]);
        assert_eq!(report["verdict"], "pass", "{report}");
    }
}

#[test]
fn an_output_that_means_something_only_at_times_is_compared_then() {
    map("second_port", "histogram_builder", "icarus");
    map("second_port", "histogram_builder", "verilator");
    let folder = common::empty();
    let text = fs::read_to_string(format!("{THEIRS}/second_port/map.toml")).unwrap();
    let refused = |old: &str, new: &str| {
        fs::write(folder.path().join("map.toml"), text.replace(old, new)).unwrap();
        let args = ["verify", "--rtl", &format!("{THEIRS}/second_port"), "--map", "map.toml"];
        common::refused(folder.path(), &args)
    };
    let error = refused("hits = \"shows\"", "hits = \"clear_word\"");
    assert!(error.contains("map.toml:3:") && error.contains("unknown port of one bit"), "{error}");
    let error = refused("hits = \"shows\"", "code = \"shows\"");
    assert!(error.contains("unknown output") && error.contains("expected one of count"), "{error}");
}

#[test]
fn counts_may_be_an_array_of_words() {
    map("array_port", "histogram_builder", "icarus");
}

#[test]
fn what_a_design_does_not_have_is_in_no_report_and_no_waveform() {
    let no_window = |_: &str, text: String| {
        let text = text.replace("output reg window ", "");
        let text = text
            .replace("coarse,  //", "coarse   //")
            .replace("reg window_next;", "reg window, window_next;");
        text.replace("coarse + 1'b1", "coarse + 2'd2")
    };
    let folder = changed(&["coarse_counter"], no_window);
    fs::write(folder.path().join("map.toml"), "[block.coarse_counter]\nignore = [\"window\"]\n")
        .unwrap();
    let args =
        ["verify", "--rtl", ".", "--block", "coarse_counter", "--map", "map.toml", "-o", "."];
    let output = common::output(folder.path(), &args);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("coarse  got") && !text.contains("window"), "{text}");
    let wave = fs::read_to_string(folder.path().join("coarse_counter.vcd")).unwrap();
    assert!(wave.contains("coarse") && !wave.contains("window"), "{wave}");
}
