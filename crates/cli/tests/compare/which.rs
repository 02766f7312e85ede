//! Tests of the matching of signals: names, maps, slices.

use crate::common;

use super::{csv, different, differing, refused, same, vcd, write};

/// Lines of a table.
pub(super) fn rows(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|&row| row.to_owned()).collect()
}

#[test]
fn names_are_matched_by_their_end_whatever_their_case_and_separators() {
    let folder = common::empty();
    let folder = folder.path();
    let values = rows(&["0,1", "1,2", "0,3", "1,2"]);
    write(folder, "a.csv", &csv("tdc/hit,tdc/tdc_decoder/n[3:0]", "HEX,HEX", 1, &values));
    write(folder, "b.csv", &csv("top/TDC/Hit,TDC_decoder/N[3:0]", "HEX,HEX", 1, &values));
    let json = same(folder, &["a.csv", "b.csv"]);
    let by = |k: usize| json["signals"][k]["matched_by"].as_str().unwrap();
    assert_eq!((by(0), by(1)), ("suffix", "suffix"));
}

#[test]
fn a_name_that_fits_several_signals_is_left_and_said_why() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("x,hit", "HEX,HEX", 0, &rows(&["0,0", "1,1"])));
    write(
        folder,
        "b.csv",
        &csv("x,tdc/hit,latch/hit", "HEX,HEX,HEX", 0, &rows(&["0,0,0", "1,1,1"])),
    );
    let json = different(folder, &["a.csv", "b.csv"]);
    let reasons = json["unmatched"].to_string();
    assert!(reasons.contains("several on the other side: tdc/hit, latch/hit"), "{reasons}");
    same(folder, &["a.csv", "b.csv", "--ignore", "*hit"]);
    write(folder, "map.toml", "ignore = [\"latch/hit\"]\n");
    same(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
}

#[test]
fn names_below_different_scopes_are_matched_by_the_longest_end_that_is_unique() {
    let folder = common::empty();
    let folder = folder.path();
    let ones = "HEX,HEX,HEX";
    let values = rows(&["0,1,0", "1,0,0", "0,1,1"]);
    let board = "top_i/BIST_0/inst/axi_ready,top_i/BIST_0/inst/axi_valid,top_i/led";
    write(folder, "a.csv", &csv(board, ones, 1, &values));
    write(folder, "b.csv", &csv("tb.dut.inst.axi_ready,tb.dut.axi_valid,x.led", ones, 1, &values));
    let json = same(folder, &["a.csv", "b.csv"]);
    assert!(json["signals"].as_array().unwrap().iter().all(|pair| pair["matched_by"] == "tail"));
    let text = common::stdout(folder, &["compare", "a.csv", "b.csv"]);
    let told = "matched   3 by the ends of both names\n            \
        top_i/BIST_0/inst/axi_ready and tb.dut.inst.axi_ready\n";
    assert!(text.contains(told), "{text}");
    let lines: Vec<_> = text.lines().skip_while(|line| !line.contains("--map")).take(4).collect();
    let map: String = lines.iter().map(|line| line.trim_start().to_owned() + "\n").collect();
    write(folder, "map.toml", &map.replace("tb.dut.inst.axi_ready", "tb.dut.axi_valid"));
    let json = different(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    let pairs = json["signals"].as_array().unwrap();
    assert!(pairs.iter().any(|pair| pair["matched_by"] == "map"), "{json:#}");
}

#[test]
fn an_end_that_a_third_signal_has_too_matches_nothing() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("x,p/u/hit", "HEX,HEX", 0, &rows(&["0,0", "1,1"])));
    let values = rows(&["0,0,0", "1,1,1"]);
    write(folder, "b.csv", &csv("x,q/v/hit,r/w/hit", "HEX,HEX,HEX", 0, &values));
    for files in [["a.csv", "b.csv"], ["b.csv", "a.csv"]] {
        let json = different(folder, &files);
        assert_eq!(json["signals"].as_array().unwrap().len(), 1, "{json:#}");
    }
    // The longer end decides, though the shorter is that of several.
    write(folder, "b.csv", &csv("x,q/u/hit,r/w/hit", "HEX,HEX,HEX", 0, &values));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert_eq!(
        (json["signals"][1]["other"].as_str(), json["unmatched"].as_array().unwrap().len()),
        (Some("q/u/hit"), 1)
    );
}

#[test]
fn a_signal_of_another_width_is_left_and_said_why() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("x,n[3:0]", "HEX,HEX", 0, &rows(&["0,0", "1,1"])));
    write(folder, "b.csv", &csv("x,n[7:0]", "HEX,HEX", 0, &rows(&["0,00", "1,01"])));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert!(json["unmatched"].to_string().contains("4 bits here, 8 on the other side"));
}

#[test]
fn slices_are_joined_as_the_map_says() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("data[17:0]", "HEX", 1, &rows(&["00001", "3abcd", "2ffff"])));
    let split = rows(&["0001,0", "abcd,3", "ffff,2"]);
    write(folder, "b.csv", &csv("reg_1[15:0],u_ila_0_reg_1[17:16]", "HEX,HEX", 1, &split));
    different_or_refused(folder);
    let map = "[[signal]]\na = [\"data\"]\nb = [\"u_ila_0_reg_1\", \"reg_1\"]\n";
    write(folder, "map.toml", map);
    same(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    let by_range = "[[signal]]\na = [\"data[17:16]\", \"data[15:0]\"]\n\
        b = [\"u_ila_0_reg_1[17:16]\", \"reg_1[15:0]\"]\n";
    write(folder, "map.toml", by_range);
    same(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    write(folder, "map.toml", "[[signal]]\na = [\"data[16]\"]\nb = [\"u_ila_0_reg_1[16]\"]\n");
    let args = ["a.csv", "b.csv", "--map", "map.toml", "--ignore", "*reg_1"];
    same(folder, &args);
    write(folder, "map.toml", "[[signal]]\na = [\"data[18]\"]\nb = [\"reg_1[0]\"]\n");
    let error = refused(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    assert!(error.contains("data[18]: expected a slice within [17:0]"), "{error}");
}

fn different_or_refused(folder: &std::path::Path) {
    let error = refused(folder, &["a.csv", "b.csv"]);
    assert!(error.contains("no signal of one has a partner in the other"), "{error}");
}

#[test]
fn names_are_changed_by_regular_expressions() {
    let folder = common::empty();
    let folder = folder.path();
    let values = rows(&["0,1", "1,2"]);
    write(folder, "a.csv", &csv("hit,code[3:0]", "HEX,HEX", 0, &values));
    let heads = "u_ila_0_hit_1,u_ila_0_code_1[3:0]";
    write(folder, "b.csv", &csv(heads, "HEX,HEX", 0, &values));
    let map = "[[rename]]\nside = \"b\"\npattern = '^u_ila_0_(.*)_1$'\nby = '$1'\n";
    write(folder, "map.toml", map);
    same(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
}

#[test]
fn a_map_with_the_sides_exchanged_is_turned_round_as_a_whole() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("x[3:0],y", "HEX,HEX", 0, &rows(&["1,0", "2,1", "3,0", "4,0"])));
    let late = rows(&["f,0", "1,1", "2,0", "3,0"]);
    write(folder, "b.csv", &csv("u_x[3:0],u_y", "HEX,HEX", 0, &late));
    let map = "[[rename]]\nside = \"b\"\npattern = '^u_'\nby = ''\n\n\
        [[signal]]\na = [\"x\"]\nb = [\"u_x\"]\nlatency = 1\n";
    write(folder, "map.toml", map);
    for files in [["a.csv", "b.csv"], ["b.csv", "a.csv"]] {
        let json = same(folder, &[&files[..], &["--map", "map.toml"]].concat());
        assert_eq!(json["signals"].as_array().unwrap().len(), 2);
    }
    let both = [(1, "u_y"), (1, "z")];
    write(folder, "a.vcd", &vcd("1ns", "top", &both, "#0\n0a\n0b\n#5\n1a\n"));
    let b = [(1, "y"), (1, "w")];
    write(folder, "b.vcd", &vcd("1ns", "top", &b, "#0\n0a\n0b\n#5\n1a\n"));
    let map = "[[rename]]\nside = \"b\"\npattern = 'u_'\nby = ''\n\n\
        [[signal]]\na = [\"w\"]\nb = [\"z\"]\n";
    write(folder, "map.toml", map);
    let json = same(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2, "{json:#}");
}

#[test]
fn the_nearest_name_is_taken_and_its_case_tells_two_apart() {
    let folder = common::empty();
    let folder = folder.path();
    let names = |variables: &[(u32, &str)], body| vcd("1ns", "top", variables, body);
    write(folder, "a.vcd", &names(&[(1, "drain"), (1, "Drain")], "#0\n0a\n1b\n#5\n1a\n"));
    write(folder, "b.vcd", &names(&[(1, "Drain"), (1, "drain")], "#0\n1a\n0b\n#5\n1b\n"));
    let json = same(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2, "{json:#}");
    // What two share with one of the other side is nobody's.
    write(folder, "a.csv", &csv("x,u/hit,v/hit", "HEX,HEX,HEX", 0, &rows(&["0,0,0", "1,1,1"])));
    write(folder, "b.csv", &csv("x,hit", "HEX,HEX", 0, &rows(&["0,0", "1,1"])));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 1, "{json:#}");
    // A name that is the same goes before one that ends so.
    write(folder, "b.csv", &csv("x,u/x", "HEX,HEX", 0, &rows(&["0,1", "1,0"])));
    write(folder, "map.toml", "[[signal]]\na = [\"x\"]\nb = [\"x\"]\n");
    let json = same(folder, &["b.csv", "b.csv", "--map", "map.toml"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
}

#[test]
fn a_bus_has_its_partner_only_if_the_slices_are_all_of_it() {
    let folder = common::empty();
    let folder = folder.path();
    let slices = |heads: &str, cells: &[&str]| csv(heads, "HEX,HEX,HEX", 0, &rows(cells));
    write(folder, "b.csv", &csv("x,n[7:0]", "HEX,HEX", 0, &rows(&["0,a5", "1,5a"])));
    write(folder, "a.csv", &slices("x,n[7:4],n[3:0]", &["0,a,5", "1,5,a"]));
    for files in [["a.csv", "b.csv"], ["b.csv", "a.csv"]] {
        assert_eq!(same(folder, &files)["signals"].as_array().unwrap().len(), 3);
    }
    write(folder, "a.csv", &slices("x,n[7:4],n[2:0]", &["0,a,5", "1,5,2"]));
    for (side, files) in [("b", ["a.csv", "b.csv"]), ("a", ["b.csv", "a.csv"])] {
        let json = different(folder, &files);
        let [unmatched] = &json["unmatched"].as_array().unwrap()[..] else { panic!("{json:#}") };
        assert_eq!((&unmatched["side"], &unmatched["name"]), (&side.into(), &"n".into()));
        assert_eq!(unmatched["reason"], "1 of its bits are not on the other side");
        assert_eq!(json["signals"].as_array().unwrap().len(), 3);
        let json = same(folder, &[&files[..], &["--ignore", "n"]].concat());
        assert_eq!(json["signals"].as_array().unwrap().len(), 1, "{json:#}");
    }
}

#[test]
fn slices_count_from_the_signal_s_own_lowest_bit() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &vcd("1ns", "top", &[(4, "n [7:4]")], "#0\nb0110 a\n#5\nb0101 a\n"));
    write(folder, "b.vcd", &vcd("1ns", "top", &[(2, "m [1:0]")], "#0\nb11 a\n#5\nb10 a\n"));
    let map = |slice| format!("[[signal]]\na = [\"n[{slice}]\"]\nb = [\"m\"]\n");
    write(folder, "map.toml", &map("6:5"));
    same(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
    for slice in ["4:3", "8:7"] {
        write(folder, "map.toml", &map(slice));
        let error = refused(folder, &["a.vcd", "b.vcd", "--map", "map.toml"]);
        assert!(error.contains("expected a slice within [7:4]"), "{error}");
    }
}

#[test]
fn bits_may_be_left_out_and_levels_exchanged() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("n[7:0],low", "HEX,HEX", 0, &rows(&["a5,0", "17,1"])));
    write(folder, "b.csv", &csv("n[7:0],low", "HEX,HEX", 0, &rows(&["a1,1", "13,0"])));
    assert_eq!(differing(&different(folder, &["a.csv", "b.csv"])), ["n", "low"]);
    let map = "[[signal]]\na = [\"n\"]\ndont_care = \"0x4\"\n\n\
        [[signal]]\na = [\"low\"]\ninvert = true\n";
    write(folder, "map.toml", map);
    same(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
    write(folder, "map.toml", &map.replace("0x4", "0x2"));
    assert_eq!(differing(&different(folder, &["a.csv", "b.csv", "--map", "map.toml"])), ["n"]);
}

#[test]
fn values_are_shown_as_the_map_says() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("n[7:0]", "HEX", 0, &rows(&["f8"])));
    write(folder, "b.csv", &csv("n[7:0]", "HEX", 0, &rows(&["08"])));
    let first = |map: &str| {
        write(folder, "map.toml", map);
        let json = different(folder, &["a.csv", "b.csv", "--map", "map.toml"]);
        json["first"]["first"]["expected"].as_str().unwrap().to_owned()
    };
    assert_eq!(first(""), "0xf8");
    assert_eq!(first("[[signal]]\na = [\"n\"]\nsigned = true\n"), "-8");
    assert_eq!(first("[[signal]]\na = [\"n\"]\nsigned = true\nfraction = 4\n"), "-0.5 (0xf8)");
    assert_eq!(first("[[signal]]\na = [\"n\"]\nfraction = 3\n"), "31 (0xf8)");
}

#[test]
fn only_the_signals_asked_for_are_compared() {
    let folder = common::empty();
    let folder = folder.path();
    let variables = [(1, "x"), (1, "y"), (1, "z")];
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, "#0\n0a\n0b\n0c\n#5\n1a\n"));
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, "#0\n0a\n1b\n0c\n#5\n1a\n"));
    different(folder, &["a.vcd", "b.vcd"]);
    let json = same(folder, &["a.vcd", "b.vcd", "--signals", "x", "--signals", "top.z"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
    same(folder, &["a.vcd", "b.vcd", "--ignore", "y"]);
}

#[test]
fn a_waveform_s_lonely_signals_count_only_if_asked() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &vcd("1ns", "top", &[(1, "x"), (1, "y")], "#0\n0a\n0b\n#5\n1a\n"));
    write(folder, "b.vcd", &vcd("1ns", "top", &[(1, "x")], "#0\n0a\n#5\n1a\n"));
    let json = same(folder, &["a.vcd", "b.vcd"]);
    assert!(json["unmatched"].to_string().contains("top.y"));
    let json = different(folder, &["a.vcd", "b.vcd", "--all"]);
    assert!(json["differences"].to_string().contains("top.y is not compared"));
}

#[test]
fn a_map_that_names_what_there_is_not_is_refused() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("hit,n[3:0]", "HEX,HEX", 0, &rows(&["0,1"])));
    let refused = |map: &str| {
        write(folder, "map.toml", map);
        refused(folder, &["a.csv", "a.csv", "--map", "map.toml"])
    };
    let error = refused("[[signal]]\na = [\"hut\"]\nb = [\"hit\"]\n");
    assert!(error.contains("map: signal: a.csv: hut: no such signal; near it: hit"), "{error}");
    let error = refused("[[signal]]\na = [\"hit\"]\nb = [\"n\"]\n");
    assert!(error.contains("expected signals of one width, not 1 and 4 bits"), "{error}");
    assert!(refused("clok = \"x\"\n").contains("did you mean `clock`?"));
    assert!(refused("align = \"somehow\"\n").contains("expected start, trigger"));
    let error = super::refused(folder, &["a.csv", "a.csv", "--map", "fig_6_7"]);
    assert!(error.contains("fig_6_6"), "{error}");
}
