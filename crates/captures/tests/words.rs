//! Tests of columns of words, alone and among numbers, compared with words and with bits.

use std::fs;
use std::path::Path;

use tofsim::error::Result;
use tofsim_captures::compare::{Comparison, Options, SignalMap, compare};
use tofsim_captures::source::Source;

use crate::ila::fixtures::{bytes, views_but};

const HEAD: &str = "Sample in Buffer,Sample in Window,TRIGGER,n[3:0],state[1:0]\n\
    Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX\n";

/// Creates a CSV with the given states as samples.
fn table(states: &[&str]) -> Vec<u8> {
    let rows = states.iter().enumerate();
    let rows = rows.map(|(k, state)| format!("{k},{k},{},{k},{state}\n", u8::from(k == 1)));
    format!("{HEAD}{}", rows.collect::<String>()).into_bytes()
}

/// Creates the same samples as a Vivado VCD.
fn vcd(states: &[u8]) -> Vec<u8> {
    let mut text = "$version\n\tVivado v2022.2 (64-bit)\n$end\n$timescale\n\t1ps\n$end\n\
        $scope module dut $end\n$var reg 4 \" n [3:0] $end\n$var reg 2 & state [1:0] $end\n\
        $var reg 1 ( _TRIGGER $end\n$var reg 1 ) _WINDOW $end\n$var reg 1 * _GAP $end\n\
        $upscope $end\n$enddefinitions $end\n"
        .to_owned();
    for (k, state) in states.iter().enumerate() {
        let begin = if k == 0 { "0(\n1)\n0*\n" } else { "" };
        let trigger = if k == 1 { "1(\n" } else { "" };
        text += &format!("#{k}\n{begin}b{k:b} \"\nb{state:b} &\n{trigger}");
    }
    text.into_bytes()
}

fn compared(a: &[u8], b: &[u8], map: &str) -> Result<Comparison> {
    let folder = tempfile::tempdir().unwrap();
    let source = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        Source::file(Path::new(&path), None).unwrap()
    };
    let map = SignalMap::parse("map.toml", map).unwrap();
    compare(&source("a", a), &source("b", b), &Options { map, ..Options::default() })
}

fn places(comparison: &Comparison) -> Vec<(String, u64, [u64; 2], [String; 2])> {
    let first = |pair: &tofsim_captures::compare::Compared| {
        let first = pair.first.as_ref().unwrap();
        let values = [first.expected.clone(), first.got.clone()];
        (pair.name.clone(), pair.differing, first.at, values)
    };
    comparison.differing().map(first).collect()
}

#[test]
fn a_file_with_words_equals_itself() {
    for states in [["\"idle\"", "\"run\"", "\"run\""], ["\"idle\"", "2", "3"]] {
        let result = compared(&table(&states), &table(&states), "").unwrap();
        assert!(result.is_same() && result.notes.is_empty(), "{:?}", result.notes);
        assert_eq!((result.pairs.len(), result.unmatched.len()), (2, 0));
    }
}

#[test]
fn another_word_is_found_at_its_sample() {
    let a = table(&["\"idle\"", "\"run\"", "\"run\"", "2"]);
    let b = table(&["\"idle\"", "\"run\"", "\"stop\"", "2"]);
    let values = ["run".to_owned(), "stop".to_owned()];
    let found = places(&compared(&a, &b, "").unwrap());
    assert_eq!(found, [("state".to_owned(), 1, [2, 2], values)]);
}

#[test]
fn words_without_known_bits_are_a_note_that_says_how_to_compare_them() {
    let a = table(&["\"idle\"", "\"run\"", "\"No Streams\""]);
    let result = compared(&a, &vcd(&[0, 1, 2]), "").unwrap();
    assert!(result.is_same());
    assert_eq!((result.pairs.len(), result.unmatched.len()), (1, 2));
    let notes = result.notes.join("\n");
    let note = "state is not compared because its words are `idle`, `run`, `No Streams`: the first side \
        has words, the second bits; a map says what they stand for: \
        [[signal]] a = [\"state\"], states = { idle = 0 }";
    assert!(notes.contains(note), "{notes}");
}

#[test]
fn a_map_says_what_words_stand_for() {
    let map = "[[signal]]\na = [\"state\"]\nstates = { idle = 0, run = 1, \"No Streams\" = 2 }\n";
    let a = table(&["\"idle\"", "\"run\"", "\"No Streams\""]);
    assert!(compared(&a, &vcd(&[0, 1, 2]), map).unwrap().is_same());
    assert!(compared(&vcd(&[0, 1, 2]), &a, map).unwrap().is_same());
    let found = places(&compared(&a, &vcd(&[0, 1, 3]), map).unwrap());
    assert_eq!((found.len(), found[0].2), (1, [2, 2]));
    let some = "[[signal]]\na = [\"state\"]\nstates = { idle = 0, run = 1 }\n";
    let result = compared(&a, &vcd(&[0, 1, 3]), some).unwrap();
    assert!(result.is_same());
    assert!(result.notes.join("\n").contains("not compared where the words are `No Streams`"));
    assert!(!compared(&a, &vcd(&[0, 2, 3]), some).unwrap().is_same());
}

#[test]
fn numbers_among_words_are_compared_with_bits() {
    let a = table(&["\"idle\"", "1", "2"]);
    let result = compared(&a, &vcd(&[3, 1, 2]), "").unwrap();
    assert!(result.is_same());
    assert!(result.notes.join("\n").contains("where the words are `idle`"), "{:?}", result.notes);
    let found = places(&compared(&a, &vcd(&[3, 1, 3]), "").unwrap());
    assert_eq!((found.len(), found[0].2), (1, [2, 2]));
}

#[test]
fn words_that_an_archive_knows_the_bits_of_compare_with_those_of_a_csv() {
    let csv = bytes("views/waveform.csv");
    let result = compared(&views_but(&[]), &csv, "").unwrap();
    assert!(result.is_same(), "{:?}", result.differences);
    assert_eq!((result.pairs.len(), result.unmatched.len()), (5, 0));
    let text = String::from_utf8(csv).unwrap().replace("\"run\",\"Active\"", "\"idle\",\"Active\"");
    let found = places(&compared(&views_but(&[]), text.as_bytes(), "").unwrap());
    assert_eq!((found.len(), &found[0].0[..], found[0].2), (1, "state", [1, 1]));
}

#[test]
fn a_flipped_bit_of_a_dump_is_found_at_its_probe_and_sample() {
    let dump = String::from_utf8(bytes("views/waveform.dmp")).unwrap();
    for (channel, names) in [(0, vec!["slot_0_ctrl", "slot_0_valid"]), (4, vec!["state"])] {
        for sample in 0..4 {
            let line = dump.lines().find(|line| line.contains(&format!("ch[{channel}]"))).unwrap();
            let mut flipped = line.as_bytes().to_vec();
            let place = line.len() - 4 + sample;
            flipped[place] ^= 1;
            let other = dump.replace(line, std::str::from_utf8(&flipped).unwrap());
            let found =
                compared(&views_but(&[]), &views_but(&[("waveform.dmp", other.as_bytes())]), "");
            let result = found.unwrap();
            let found: Vec<_> =
                places(&result).into_iter().map(|(n, c, at, _)| (n, c, at)).collect();
            let at = [sample as u64; 2];
            let expected: Vec<_> = names.iter().map(|name| (name.to_string(), 1, at)).collect();
            assert_eq!(found, expected);
            // A word that is there once is taken for what the bits then say.
            let is_noted = result.notes.iter().any(|note| note.contains("cells of waveform.csv"));
            assert!(is_noted || channel == 4);
        }
    }
}
