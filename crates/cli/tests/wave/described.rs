//! What a run's FST says of itself and of its signals, read by GTKWave's tool and shown by `tofsim wave`.

use std::fs;

use crate::common::{self, json, stdout};

use super::{convert, tool};

#[test]
fn an_fst_has_its_record_and_the_meaning_of_its_signals_in_comments() {
    let folder = common::empty();
    let folder = folder.path();
    stdout(folder, &["run", "--waves", "fst", "--window", "shot:0..2", "-o", "."]);
    let text = tool(folder, &["fst2vcd", "-e", "kc705.fst"]);
    let record = text.lines().find_map(|line| line.trim().strip_prefix("tofsim-record ")).unwrap();
    let record: serde_json::Value = serde_json::from_str(record).unwrap();
    assert_eq!(record["command"][0], "run");
    let before_the_time = [
        "$comment\n\tTime from the begin of bin 0\n$end",
        "$attrbegin misc 02 signed/2^4[25_ps] 0 $end",
        "$var reg 17 ",
    ];
    assert!(text.contains(&before_the_time.join("\n")), "{text}");
    let place = text.find("$scope module tdc_decoder").unwrap();
    let before: Vec<_> = text[..place].lines().rev().take(3).collect();
    assert_eq!(before[2], "$attrbegin misc 03 rtl_ref/tdc_decoder.v 14 $end", "{before:?}");
    assert!(
        before[1].starts_with("$attrbegin misc 04 14 ")
            && before[0].starts_with("$attrbegin misc 05 "),
        "{before:?}"
    );
    // Other tools read what GTKWave's writes of it.
    fs::write(folder.join("again.vcd"), &text).unwrap();
    let again = json(folder, &["wave", "info", "again.vcd", "--json"]);
    let types = again["signals"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|signal| !signal["value_type"].is_null());
    assert!(types.count() > 200);
}

#[test]
fn what_a_file_says_of_signals_is_listed_and_kept() {
    let folder = common::empty();
    let folder = folder.path();
    stdout(folder, &["run", "--waves", "fst", "--window", "shot:0..2", "-o", "."]);
    let listed = stdout(folder, &["wave", "info", "kc705.fst", "-v"]);
    let line = listed.lines().find(|line| line.trim().starts_with("tof_top.depth ")).unwrap();
    assert!(
        line.contains("signed/2^29[m]") && line.contains("The depth, from `algo_done`"),
        "{line}"
    );
    assert!(listed.contains("scenario kc705") && !listed.contains("tofsim-record"));
    stdout(folder, &["wave", "cut", "kc705.fst", "-o", "cut.fst", "--signals", "*depth"]);
    convert(folder, "cut.fst", "again.vcd");
    convert(folder, "again.vcd", "again.fst");
    let [first, cut, again] = ["kc705.fst", "cut.fst", "again.fst"].map(|name| {
        let info = json(folder, &["wave", "info", name, "--json"]);
        let depth = info["signals"]
            .as_array()
            .unwrap()
            .iter()
            .find(|signal| signal["name"] == "tof_top.depth");
        let depth = depth.unwrap();
        (info["comments"].clone(), depth["value_type"].clone(), depth["meaning"].clone())
    });
    assert_eq!((&first.1, &first.2), (&cut.1, &cut.2));
    assert_eq!(again.1, first.1);
    assert_eq!(cut.0[0], "converted from kc705.fst");
    assert_eq!(cut.0[2], first.0[1]);
    let record = first.0.as_array().unwrap().last().unwrap().as_str().unwrap();
    let kept = cut.0.as_array().unwrap().last().unwrap().as_str().unwrap();
    assert_eq!(Some(kept), record.strip_prefix("tofsim-"));
}
