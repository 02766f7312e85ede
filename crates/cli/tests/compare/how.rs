//! Tests of the exactness of comparisons.

use std::fs;

use crate::common;

use super::{compare, csv, different, differing, refused, same, vcd, write};

fn rows(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|&row| row.to_owned()).collect()
}

#[test]
fn an_unknown_bit_is_itself_or_anything_or_nothing() {
    let folder = common::empty();
    let folder = folder.path();
    let variables = [(4, "n")];
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, "#0\nb1x01 a\n#9\nb1111 a\n"));
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, "#0\nb1101 a\n#9\nb1111 a\n"));
    let json = different(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(json["first"]["first"]["expected"], "0b1x01");
    same(folder, &["a.vcd", "a.vcd"]);
    same(folder, &["a.vcd", "b.vcd", "--x", "any"]);
    same(folder, &["b.vcd", "a.vcd", "--x", "any"]);
    different(folder, &["a.vcd", "b.vcd", "--x", "none"]);
    different(folder, &["a.vcd", "a.vcd", "--x", "none"]);
    write(folder, "z.vcd", &vcd("1ns", "top", &variables, "#0\nb1z01 a\n#9\nb1111 a\n"));
    different(folder, &["a.vcd", "z.vcd"]);
    write(folder, "low.vcd", &vcd("1ns", "top", &variables, "#0\nb1001 a\n#9\nb1111 a\n"));
    different(folder, &["a.vcd", "low.vcd"]);
    different(folder, &["b.vcd", "low.vcd", "--x", "any"]);
    write(folder, "weak.vcd", &vcd("1ns", "top", &variables, "#0\nbhl0h a\n#9\nb1111 a\n"));
    same(folder, &["weak.vcd", "low.vcd"]);
    write(folder, "a.csv", &csv("n[3:0]", "HEX", 0, &rows(&["0", "0", "0"])));
    write(folder, "b.csv", &csv("n[3:0]", "HEX", 0, &rows(&["0", "X", "0"])));
    assert_eq!(different(folder, &["a.csv", "b.csv"])["first"]["differing"], 1);
}

#[test]
fn an_exchanged_level_that_is_unknown_stays_so() {
    let folder = common::empty();
    let folder = folder.path();
    let write = |name, body| write(folder, name, &vcd("1ns", "top", &[(2, "n")], body));
    write("a.vcd", "#0\nb0x a\n#9\nb0z a\n");
    write("b.vcd", "#0\nb1x a\n#9\nb1z a\n");
    fs::write(folder.join("map.toml"), "[[signal]]\na = [\"n\"]\ninvert = true\n").unwrap();
    same(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
    different(folder, &["a.vcd", "a.vcd", "--map", "map.toml"]);
}

#[test]
fn numbers_may_differ_by_their_tolerance() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("n[7:0],m[7:0]", "SIGNED,UNSIGNED", 0, &rows(&["-1,255", "5,7"])));
    write(folder, "b.csv", &csv("n[7:0],m[7:0]", "SIGNED,UNSIGNED", 0, &rows(&["1,253", "5,7"])));
    let args = ["a.csv", "b.csv", "--tolerance", "m=2"];
    assert_eq!(differing(&different(folder, &args)), ["n"]);
    same(folder, &[&args[..], &["--tolerance", "n=2"]].concat());
    let args = ["a.csv", "b.csv", "--tolerance", "m=1", "--tolerance", "n=2"];
    assert_eq!(differing(&different(folder, &args)), ["m"]);
    let error = refused(folder, &["a.csv", "b.csv", "--tolerance", "q=1"]);
    assert!(error.contains("q: no such signal"), "{error}");
    let error = refused(folder, &["a.csv", "b.csv", "--tolerance", "n=x"]);
    assert!(error.contains("expected SIGNAL=VALUE with a whole number"), "{error}");
}

#[test]
fn a_floating_point_number_has_no_tolerance_in_bits() {
    let folder = common::empty();
    let folder = folder.path();
    let text = |value: &str| {
        vcd("1ns", "top", &[(64, "r")], &format!("#0\nr{value} a\n#5\nr0 a\n"))
            .replace("wire 64", "real 64")
    };
    write(folder, "a.vcd", &text("1.0"));
    write(folder, "b.vcd", &text("1.0000000000000002"));
    same(folder, &["a.vcd", "a.vcd"]);
    different(folder, &["a.vcd", "b.vcd", "--tolerance", "r=1"]);
    write(folder, "bits.vcd", &vcd("1ns", "top", &[(64, "r"), (1, "x")], "#0\nb0 a\n0b\n"));
    write(
        folder,
        "real.vcd",
        &(text("0.0").replace("$upscope", "$var wire 1 b x $end\n$upscope") + "0b\n"),
    );
    let json = compare(folder, &["bits.vcd", "real.vcd"]).1;
    assert!(
        json["unmatched"].to_string().contains("bits here, real numbers on the other side"),
        "{json:#}"
    );
}

#[test]
fn a_latency_is_taken_out_of_one_signal() {
    let folder = common::empty();
    let folder = folder.path();
    let pair = |x: usize, y: usize| format!("{:x},{:x}", x % 16, y % 16);
    let plain: Vec<_> = (2..30).map(|k| pair(k, 3 * k)).collect();
    let late: Vec<_> = (2..30).map(|k| pair(k, 3 * (k - 2))).collect();
    write(folder, "a.csv", &csv("x[3:0],y[3:0]", "HEX,HEX", 0, &plain));
    write(folder, "b.csv", &csv("x[3:0],y[3:0]", "HEX,HEX", 0, &late));
    assert_eq!(differing(&different(folder, &["a.csv", "b.csv"])), ["y"]);
    let json = same(folder, &["a.csv", "b.csv", "--latency", "y=2"]);
    let compared = |name: &str| {
        let signals = json["signals"].as_array().unwrap().iter();
        signals.clone().find(|signal| signal["name"] == name).unwrap()["compared"].clone()
    };
    assert_eq!((compared("x"), compared("y")), (28.into(), 26.into()));
    same(folder, &["b.csv", "a.csv", "--latency", "y=-2"]);
    different(folder, &["a.csv", "b.csv", "--latency", "y=1"]);
    let variables = [(1, "x")];
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, "#0\n0a\n"));
    let error = refused(folder, &["a.vcd", "a.vcd", "--latency", "x=1"]);
    assert!(error.contains("--clock"), "{error}");
}

#[test]
fn a_signal_may_be_compared_only_where_another_is_high() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("ok,n[3:0]", "HEX,HEX", 0, &rows(&["0,1", "1,2", "0,3", "1,4"])));
    write(folder, "b.csv", &csv("ok,n[3:0]", "HEX,HEX", 0, &rows(&["0,9", "1,2", "0,f", "1,4"])));
    different(folder, &["a.csv", "b.csv"]);
    same(folder, &["a.csv", "b.csv", "--valid", "n=ok"]);
    write(folder, "b.csv", &csv("ok,n[3:0]", "HEX,HEX", 0, &rows(&["0,9", "1,2", "0,f", "1,5"])));
    let json = different(folder, &["a.csv", "b.csv", "--valid", "n=ok"]);
    assert_eq!(json["first"]["differing"], 1);
    // It counts from the instant on at which the other becomes high.
    let variables = [(1, "ok"), (2, "n")];
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, "#0\nza\nb01 b\n#9\n1a\n#12\n1a\n"));
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, "#0\nza\nb10 b\n#9\n1a\n#12\n1a\n"));
    let valid = ["a.vcd", "b.vcd", "--valid", "n=ok"];
    assert_eq!(different(folder, &valid)["first"]["first"]["at"][0], 9000.0);
    same(folder, &[&valid[..], &["--until", "9ns"]].concat());
    let error = refused(folder, &["a.csv", "b.csv", "--valid", "ok=n"]);
    assert!(error.contains("expected a signal of one bit"), "{error}");
}

#[test]
fn a_wide_signal_is_compared_bit_by_bit() {
    let folder = common::empty();
    let folder = folder.path();
    let wide = |digit: &str| format!("{}{digit}{}", "a".repeat(40), "5".repeat(59));
    write(folder, "a.csv", &csv("n[399:0]", "HEX", 0, &[wide("3"), wide("4")]));
    write(folder, "b.csv", &csv("n[399:0]", "HEX", 0, &[wide("3"), wide("5")]));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert_eq!(json["first"]["first"]["bits"].to_string(), "[236]");
    same(folder, &["a.csv", "a.csv"]);
    // A mask says nothing of the bits beyond it.
    write(folder, "map.toml", "[[signal]]\na = [\"n\"]\ndont_care = \"0xffffffffffffffff\"\n");
    different(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    for (slice, differs) in [("[239:230]", true), ("[235:120]", false), ("[299:237]", false)] {
        let map = format!("[[signal]]\na = [\"n{slice}\"]\nb = [\"n{slice}\"]\n");
        write(folder, "map.toml", &map);
        let json = compare(folder, &["a.csv", "b.csv", "--map", "map.toml"]).1;
        assert_eq!(differing(&json).len(), usize::from(differs), "{slice}");
    }
}

#[test]
fn decimals_of_128_bits_are_read_and_compared() {
    let folder = common::empty();
    let folder = folder.path();
    let most = u128::MAX.to_string();
    let least = i128::MIN.to_string();
    let heads = "n[127:0],m[127:0]";
    write(folder, "a.csv", &csv(heads, "UNSIGNED,SIGNED", 0, &[format!("{most},{least}")]));
    let hexadecimal = format!("{},8{}", "f".repeat(32), "0".repeat(31));
    write(folder, "b.csv", &csv(heads, "HEX,HEX", 0, &[hexadecimal]));
    same(folder, &["a.csv", "b.csv"]);
}
