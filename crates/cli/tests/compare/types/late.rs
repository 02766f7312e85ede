//! Single signals that are late or early.

use crate::common;

use super::super::{different, findings, same, vcd, write};

/// A clock, a word and a bit that is high for some clocks; the bit is `late` ns late.
fn late_bit(late: u64) -> String {
    let mut body = String::new();
    for at in 0..400u64 {
        body += &format!("#{at}\n");
        if at % 5 == 0 {
            body += &format!("{}a\n", at / 5 % 2);
        }
        if at % 10 == 7 {
            body += &format!("b{:b} b\n", at / 10 % 16);
        }
        let level = |at: u64| u8::from(at % 70 < 20 || at % 110 > 90);
        let [now, before] = [at + 400 - late, at + 399 - late].map(level);
        if at == 0 || now != before {
            body += &format!("{now}c\n");
        }
    }
    vcd("1 ns", "top", &[(1, "clk"), (4, "n [3:0]"), (1, "valid")], &body)
}

#[test]
fn a_single_signal_that_is_late_is_found_in_samples_and_in_time() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &late_bit(0));
    write(folder, "b.vcd", &late_bit(30));
    for (args, text) in [
        (&["a.vcd", "b.vcd", "--clock", "clk"][..], "top.valid is 3 samples later"),
        (&["b.vcd", "a.vcd", "--clock", "clk"], "top.valid is 3 samples earlier"),
        (&["a.vcd", "b.vcd"], "top.valid is 30 ns later on the second side"),
        (&["b.vcd", "a.vcd"], "top.valid is 30 ns earlier on the second side"),
    ] {
        let json = different(folder, args);
        assert_eq!(findings(&json), ["shifted signal"], "{args:?}");
        let found = json["findings"].to_string();
        assert!(found.contains(text), "{args:?}: {found}");
    }
    same(folder, &["a.vcd", "b.vcd", "--clock", "clk", "--latency", "top.valid=3"]);
}

/// The waveform with all times later.
fn later(text: &str, by: u64) -> String {
    let line = |line: &str| match line.strip_prefix('#').and_then(|at| at.parse::<u64>().ok()) {
        Some(at) => format!("#{}\n", at + by),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

#[test]
fn a_late_signal_is_found_whatever_its_alignment_and_map() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &late_bit(0));
    // All is 50 ns late, and the bit by 30 ns more; its initial value is from before the start.
    write(folder, "b.vcd", &later(&late_bit(30), 50));
    let args = ["a.vcd", "b.vcd", "--align", "offset 50ns", "--until", "300ns"];
    let json = different(folder, &args);
    assert!(json["findings"].to_string().contains("valid is 30 ns later"), "{}", json["findings"]);
    let inverted: String = late_bit(30)
        .lines()
        .map(|line| match line {
            "0c" => "1c\n".to_owned(),
            "1c" => "0c\n".to_owned(),
            _ => format!("{line}\n"),
        })
        .collect();
    write(folder, "c.vcd", &inverted);
    write(
        folder,
        "map.toml",
        "[[signal]]\na = [\"top.valid\"]\nb = [\"top.valid\"]\ninvert = true\n",
    );
    let json = different(folder, &["a.vcd", "c.vcd", "--map", "map.toml"]);
    assert!(json["findings"].to_string().contains("valid is 30 ns later"), "{}", json["findings"]);
}
