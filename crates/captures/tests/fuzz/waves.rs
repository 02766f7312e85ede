//! Fuzz tests of waveforms, which a library reads whose panics must be caught.

use std::fs;
use std::sync::OnceLock;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::TestCaseError;

use tofsim::hierarchy;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::waves::{WaveFormat, Waves};
use tofsim_captures::compare::{Options, compare};
use tofsim_captures::ila::{Capture, Probe, Radix, write};
use tofsim_captures::source::Source;

use crate::common;

use super::edit::{edited, edits, planted, plants};
use super::fuzz;

/// Texts with a meaning in a VCD.
const PIECES: [&str; 28] = [
    "\n",
    " ",
    "#",
    "#0\n",
    "#18446744073709551616\n",
    "$end",
    "$scope module a $end\n",
    "$upscope $end\n",
    "$var wire 1 ! x $end\n",
    "$var wire 4294967295 ! x $end\n",
    "$var wire 0 \" y [3:0] $end\n",
    "$var real 64 % r $end\n",
    "$var string 1 & s $end\n",
    "$var event 1 ' e $end\n",
    "$var wire 1 ~~~~~~~~~~~~~~~~ z $end\n",
    "$enddefinitions $end\n",
    "$dumpvars\n",
    "$comment",
    "$attrbegin misc 07 a 2 b c 0 1 1 $end\n",
    "$timescale 0s $end",
    "r1e999 %\n",
    "sab\\x00 &\n",
    "b !\n",
    "b2 \"\n",
    "bzx01 \"\n",
    "[",
    "\\",
    "\u{feff}",
];

const VCD: &str = "$version hand $end\n$timescale 10ps $end\n$scope module top $end\n\
    $var wire 1 ! clk $end\n$var reg 8 \" n [7:0] $end\n$var real 64 % r $end\n\
    $scope module gen[0] $end\n$var wire 1 ! clk $end\n$upscope $end\n$upscope $end\n\
    $enddefinitions $end\n#0\n$dumpvars\n0!\nbx \"\nr0.5 %\n$end\n#5\n1!\nb101 \"\n#10\n0!\n\
    b11111111 \"\nr-2 %\n#15\n1!\n";

const GHW: &[u8] = include_bytes!("../ghdl/counter.ghw");

/// Returns a small FST file written by tofsim.
fn fst() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kc705.fst");
        let setup = common::setup("kc705", &["firmware.shots_per_frame=1"]);
        let mut entries = hierarchy::entries(&setup.params);
        entries.retain(|entry| entry.scope.starts_with("tof_top.tdc"));
        let encoder = &setup.params.tdc.decoder.encoder;
        let waves = Waves::create(&path, WaveFormat::Fst, &entries, encoder, &[]).unwrap();
        let windows = setup.windows(&[], 1).unwrap();
        let watch = Observers { waves: Some((waves, windows)), ..Observers::default() };
        Run::new(&setup).observe(1, watch).unwrap();
        fs::read(path).unwrap()
    })
}

/// Returns a logic analyser's VCD.
fn capture() -> Vec<u8> {
    let probe = |name: &str, width: u32| Probe {
        name: name.to_owned(),
        width,
        lsb: 0,
        vector: width > 1,
        radix: Radix::Hex,
    };
    let mut capture = Capture::new(vec![probe("a/b[3]", 1), probe("n", 12)]);
    capture.words = (0..16).map(|sample| sample * 77 % 8191).collect();
    (capture.windows, capture.triggers) = (vec![0, 8], vec![3, 11]);
    let mut bytes = Vec::new();
    write::vcd(&mut bytes, &capture).unwrap();
    bytes
}

/// Opens a file, and if it is valid compares it with itself.
fn drive(bytes: &[u8]) -> Result<(), TestCaseError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    let name = file.path().display().to_string();
    let named = |error: tofsim::error::Error| {
        let error = error.to_string();
        let known =
            ["compare:", "--clock:", "--align:"].iter().any(|start| error.starts_with(start));
        prop_assert!(error.starts_with(&name) || known, "{}", error);
        Ok(())
    };
    let source = match Source::file(file.path(), None) {
        Ok(source) => source,
        Err(error) => return named(error),
    };
    match compare(&source, &source, &Options::default()) {
        Ok(result) => prop_assert!(result.differing().next().is_none(), "differs from itself"),
        Err(error) => named(error)?,
    }
    Ok(())
}

#[test]
fn bytes_that_mean_nothing() {
    let head = select(vec![&b""[..], b"$date", b"GHDLwave\n", b"\x00\x00\x00"]);
    fuzz((head, vec(any::<u8>(), 0..300)), |(head, rest)| drive(&[head, &rest].concat()));
}

#[test]
fn vcds_that_are_nearly_right() {
    fuzz(edits(&PIECES), |edits| drive(&edited(VCD.into(), &edits)));
}

#[test]
fn captures_as_vcd_that_are_nearly_right() {
    fuzz(edits(&PIECES), |edits| drive(&edited(capture(), &edits)));
}

#[test]
fn fsts_that_are_nearly_right() {
    fuzz(edits(&PIECES), |edits| drive(&edited(fst().into(), &edits)));
}

#[test]
fn ghws_that_are_nearly_right() {
    fuzz(edits(&PIECES), |edits| drive(&edited(GHW.into(), &edits)));
}

#[test]
fn fsts_with_other_lengths_sizes_and_counts() {
    let heads = heads(fst());
    fuzz(plants(), |plants| drive(&planted(fst().into(), &heads, &plants)));
    let all: Vec<usize> = (0..fst().len()).collect();
    fuzz(plants(), |plants| drive(&planted(fst().into(), &all, &plants)));
}

/// Returns the positions of the first and the last bytes of an FST file's blocks.
fn heads(bytes: &[u8]) -> Vec<usize> {
    let mut heads = Vec::new();
    let mut begin = 0;
    while begin + 9 < bytes.len() {
        let length = u64::from_be_bytes(bytes[begin + 1..begin + 9].try_into().unwrap());
        let end = begin + 1 + length as usize;
        heads.extend((begin..end).filter(|place| *place < begin + 80 || *place + 40 > end));
        begin = end;
    }
    heads
}

#[test]
fn ghws_with_other_counts_and_ranges() {
    let all: Vec<usize> = (0..GHW.len()).collect();
    fuzz(plants(), |plants| drive(&planted(GHW.into(), &all, &plants)));
}
