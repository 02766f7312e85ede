//! Tests of chain files: their delays, and which files are refused.

use std::path::PathBuf;

use super::*;

const CYCLE: Time = Time::from_ns(8);

fn parse(source: &str, text: &str, files: &Source, cycle: Time) -> Result<Delays> {
    let profile =
        Profile { source: source.to_owned(), text: text.to_owned(), files: files.clone() };
    profile.delays(None, cycle)
}

#[test]
fn a_chain_is_held_to_the_period_of_its_clock() {
    let message = |cycle_fs: u64| {
        let found = load("uniform", &Source::BuiltIn, Time::from_fs(cycle_fs));
        found.map(drop).map_err(|error| error.to_string())
    };
    // From 2230 ps on, 9200 ps.
    assert_eq!((message(9_200_000), message(5_710_000)), (Ok(()), Ok(())));
    let error = message(10_000_000).unwrap_err();
    let expected = "9200 ps, expected 10 ns or more, a period of clk_sys: hits of the other 800 ps";
    assert!(error.contains(expected), "{error}");
    let expected = "use tap delays 1.087 times as long (tdc.profile), or a clk_sys of 108.696 MHz or \
        more (pll)";
    assert!(error.contains(expected), "{error}");
    let error = message(5_700_000).unwrap_err();
    let expected = "after 11418 ps, expected 11.4 ns at most, two periods of clk_sys; use one of 175.154 \
        MHz or less";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn table_6_3_is_reproduced() {
    let delays = load("table6_3", &Source::Folder(PathBuf::new()), CYCLE).unwrap();
    assert_eq!(delays.rank(Time::from_ns(8 - 2)), 328);
    assert_eq!(delays.rank(Time::from_ns(8 - 4)), 154);
    assert_eq!(delays.rank(Time::from_ns(16 - 8)), 492);
    assert_eq!(delays.rank(Time::from_ns(8 - 8)), 0, "8 ns is not seen at 8 ns");
}

#[test]
fn a_fault_names_key_and_place() {
    let message = |text| parse("c.toml", text, &Source::BuiltIn, CYCLE).unwrap_err().to_string();
    assert_eq!(
        message("offset_ps = 2000\ntap_ps = -1"),
        "c.toml:2:10: tap_ps = -1: expected a number from 0.001 to 1000.0 [ps]"
    );
    assert!(message("offset_ps = -1\ntap_ps = 12").contains("from 0.0 to 100000.0 [ps]"));
    assert!(message("offset_ps = 2000\ntap_delays_ps = [1.0]").contains("16 to 2000"));
    assert!(
        message("offset_ps = 2000\ntap_ps = 30").contains("tap_ps = 30: the last tap is reached")
    );
    assert!(message("offset_ps = 9000\ntap_ps = 9.9").contains("offset_ps = 9000: the last tap"));
    assert!(message("offset_ps = 2000\ntap_pz = 1").contains("did you mean `tap_ps`?"));
    assert!(message("offset_ps = 10\ntap_ps = 11\n[[extra]]\ntap=0\nps=-100").contains("before"));
}

#[test]
fn an_offset_may_be_left_out_or_nothing() {
    let read = |text: &str| parse("c.toml", text, &Source::BuiltIn, CYCLE).unwrap();
    assert_eq!(read("tap_ps = 11.5"), read("offset_ps = 2230\ntap_ps = 11.5"));
    let none = read("offset_ps = 0\ntap_ps = 11.5");
    assert_eq!(none.tap_0(), Time::from_fs(1));
}

#[test]
fn a_chain_shorter_than_a_clock_period_is_refused_by_how_much() {
    let message = |text: &str| {
        parse("c.toml", text, &Source::BuiltIn, CYCLE).map(drop).map_err(|e| e.to_string())
    };
    assert_eq!(
        message("offset_ps = 2230\ntap_ps = 5").unwrap_err(),
        "c.toml:2:10: tap_ps = 5: the 800 taps take 4000 ps, expected 8 ns or more, a period of \
         clk_sys: hits of the other 4000 ps would all have the same time; use tap delays 2 times \
         as long (tdc.profile), or a clk_sys of 250 MHz or more (pll)"
    );
    assert_eq!(message("offset_ps = 2230\ntap_ps = 10"), Ok(()), "800 taps of 10 ps are 8 ns");
    let error = message("offset_ps = 7000\ntap_ps = 9.999").unwrap_err();
    assert!(error.contains("the other 0.8 ps"), "the offset is no tap: {error}");
    let one_by_one = format!("offset_ps = 2000\ntap_delays_ps = [{}]", "9.5, ".repeat(TAPS));
    let error = message(&one_by_one).unwrap_err();
    assert!(error.contains("tap_delays_ps = a list of 800: the 800 taps take 7600"), "{error}");
    let longer = format!("{one_by_one}\n[[extra]]\ntap = 400\nps = 400");
    assert_eq!(message(&longer), Ok(()), "an extra delay is part of the chain");
}

#[test]
fn a_silicon_chain_without_its_effects_is_a_uniform_one_to_the_femtosecond() {
    let read = |text: &str| parse("c.toml", text, &Source::BuiltIn, CYCLE).unwrap();
    for slice_ps in [46.0, 47.3, 47.301] {
        let tap_ps = slice_ps / 4.0;
        let uniform = read(&format!("offset_ps = 2158.5\ntap_ps = {tap_ps}"));
        let keys = format!("offset_ps = 2158.5\n[silicon]\nslices = 200\nslice_ps = {slice_ps}");
        assert_eq!(read(&keys), uniform);
        assert_ne!(read(&format!("{keys}\nskew_ps = 0.1")), uniform);
    }
}

#[test]
fn a_chain_is_built_from_what_was_measured_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let base = Source::Folder(folder.path().to_owned());
    let own = load("kintex7", &Source::BuiltIn, CYCLE).unwrap();
    let width = |n: usize| own.boundary(n).fs() - own.boundary(n - 1).fs();
    let rows: String =
        (1..=800).map(|n| format!("{},{}\n", n - 1, width(n) as f64 / 1e3)).collect();
    write("delays.csv", &format!("tap,delay_ps\n{rows}"));
    let offset = own.boundary(0).fs() as f64 / 1e3;
    write("d.toml", &format!("offset_ps = {offset}\ndelays_file = \"delays.csv\""));
    let found = load("./d.toml", &base, CYCLE).unwrap();
    assert_eq!(found.arrivals(), own.arrivals(), "in the order of arrival");
    // As many hits as femtoseconds, each once.
    let counts = (0..800).map(|n| if n == 0 { 0 } else { width(n) });
    let rows: String =
        counts.clone().enumerate().map(|(n, count)| format!("{n},{count}\n")).collect();
    write("counts.csv", &format!("# every phase\nn,count\n{rows}"));
    let period = counts.sum::<u64>() as f64 / 1e3;
    let keys = format!("offset_ps = {offset}\ncounts_file = \"counts.csv\"\nperiod_ps = {period}");
    write("c.toml", &keys);
    let found = load("./c.toml", &base, CYCLE).unwrap();
    assert_eq!(found.arrivals(), &own.arrivals()[..799]);
    write("c.toml", "offset_ps = 2000\ncounts_file = \"counts.csv\"");
    assert_eq!(load("./c.toml", &base, CYCLE).unwrap().span(), CYCLE);
    write("c.toml", "offset_ps = 2000\ncounts_file = \"counts.csv\"\nperiod_ps = 7000");
    let error = load("./c.toml", &base, CYCLE).unwrap_err().to_string();
    assert!(error.contains("take 7000 ps, expected 8 ns or more"), "{error}");
    write("delays.csv", "tap,delay_ps\n0,5\n2,5\n");
    let error = load("./d.toml", &base, CYCLE).unwrap_err().to_string();
    assert!(error.contains("delays.csv:3:1: tap = 2: expected 1, the next"), "{error}");
}

#[test]
fn a_chain_says_once_what_its_delays_are() {
    let message = |text: &str| {
        let read = parse("c.toml", &format!("offset_ps = 2000\n{text}"), &Source::BuiltIn, CYCLE);
        read.unwrap_err().to_string()
    };
    let both = "tap_ps = 12\n[silicon]\nslices = 200\nslice_ps = 47";
    for text in ["", both] {
        assert!(message(text).starts_with("c.toml: expected either tap_ps or tap_delays_ps or"));
    }
    assert!(message("tap_ps = 12\nperiod_ps = 8000").contains("c.toml:3:13: period_ps"));
    let silicon = |keys: &str| message(&format!("[silicon]\nslices = 200\nslice_ps = 47\n{keys}"));
    assert!(silicon("weights = [0.5, 0.5, 0.5, 0.0]").contains("parts of one, not of 1.5"));
    assert!(silicon("co_order = [0, 1, 2, 2]").contains("each of 0, 1, 2, 3 once"));
    assert!(silicon("slice_spread = -0.1").contains("c.toml:5:16: silicon.slice_spread = -0.1"));
    assert!(silicon("weights = [0.5, 0.5, 0.0]").contains("expected a list of 4"));
    let short = message("[silicon]\nslices = 100\nslice_ps = 47");
    assert!(short.contains("the 400 taps take 4700 ps, expected 8 ns or more"), "{short}");
    assert!(short.contains("the other 3300 ps"), "{short}");
    assert!(message("counts_file = \"no.csv\"").contains("no.csv: cannot read"));
}

#[test]
fn every_built_in_chain_covers_a_clock_period() {
    for (name, _) in builtin::CHAINS {
        let delays = load(name, &Source::BuiltIn, CYCLE).unwrap();
        assert!(delays.span() > CYCLE, "{name}");
    }
}

#[test]
fn an_unknown_profile_lists_the_known_ones() {
    let error = load("unifrom", &Source::Folder(PathBuf::new()), CYCLE).unwrap_err().to_string();
    assert!(error.contains("uniform, table6_3, ideal"), "{error}");
}
