//! Tests that captures are read as they were written: the same bits, marks and names.

use std::io::Cursor;

use proptest::collection::vec;
use proptest::prelude::*;

use tofsim_captures::ila::read::{CaptureForm, CaptureRow, Opened};
use tofsim_captures::ila::{Capture, Probe, Radix, write};

use crate::ila;

const RADICES: [Radix; 5] =
    [Radix::Hex, Radix::Signed, Radix::Unsigned, Radix::Binary, Radix::Octal];
const NAMES: [&str; 4] = ["top/u_tdc/code", "r[4]", "<const0>_\"1\", & \\x", "one"];

fn probe(name: usize, width: u32, lsb: u32, radix: Radix) -> Probe {
    let name = format!("{}_{name}", NAMES[name % NAMES.len()]);
    Probe { name, width, lsb, vector: width > 1 || lsb % 2 == 1, radix }
}

/// Creates samples in windows of `depth`, the last of which may be partial, with bits that repeat `words`.
fn capture(probes: Vec<Probe>, samples: usize, depth: usize, words: &[u64]) -> Capture {
    let mut capture = Capture::new(probes);
    let unused = capture.stride * 64 - capture.width();
    for sample in 0..samples {
        for place in 0..capture.stride {
            let word = words[(sample * capture.stride + place) % words.len()];
            let last = place + 1 == capture.stride;
            capture.words.push(if last { word << unused >> unused } else { word });
        }
    }
    capture.windows = (0..samples).step_by(depth).collect();
    let trigger = depth / 2;
    capture.triggers = capture.windows.iter().map(|window| window + trigger).collect();
    capture.triggers.retain(|&trigger| trigger < samples);
    capture
}

/// Returns the bits of a probe in a row, least significant first.
fn bits(words: &[u64], low: usize, width: u32) -> Vec<bool> {
    (low..low + width as usize).map(|bit| words[bit / 64] >> (bit % 64) & 1 == 1).collect()
}

fn assert_same(capture: &Capture, opened: &Opened, rows: &[CaptureRow], named: bool) {
    assert_eq!(rows.len(), capture.samples());
    let columns = opened.columns.iter();
    for (column, probe) in columns.clone().zip(&capture.probes) {
        assert_eq!(column.width, probe.width);
        if named {
            assert_eq!(column.head(), probe.head());
        }
    }
    assert_eq!(columns.len(), capture.probes.len());
    for (sample, row) in rows.iter().enumerate() {
        let window = capture.windows.iter().rposition(|&window| window <= sample).unwrap();
        let begin = capture.windows[window];
        assert_eq!((row.sample, row.in_window), (sample as u64, (sample - begin) as u64));
        assert_eq!(row.window_start, sample == begin);
        assert_eq!(row.trigger, capture.triggers.contains(&sample));
        assert!(!row.gap && row.unknown.iter().all(|&word| word == 0));
        let words = &capture.words[sample * capture.stride..][..capture.stride];
        for (column, place) in columns.clone().zip(capture.places()) {
            let found = bits(&row.value, column.word * 64, column.width);
            assert_eq!(
                found,
                bits(words, place.start, column.width),
                "{} at {sample}",
                column.head()
            );
        }
    }
}

fn csv(capture: &Capture, radix_row: bool) -> Vec<u8> {
    let mut out = Vec::new();
    write::csv(&mut out, capture, radix_row).unwrap();
    out
}

fn archive(capture: &Capture) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    write::archive(&mut out, capture).unwrap();
    out.into_inner()
}

/// Writes and reads a capture as CSV and as archive, the latter also without its CSV and without its dump.
fn check(capture: &Capture) {
    let (opened, rows) = ila::read_bytes(&csv(capture, true), None).unwrap();
    assert_eq!(opened.form, CaptureForm::Csv);
    assert_same(capture, &opened, &rows, true);
    let (opened, rows) = ila::read_bytes(&archive(capture), None).unwrap();
    assert_eq!(opened.form, CaptureForm::Archive);
    assert_same(capture, &opened, &rows, true);
    let (mut dump, mut list) = (Vec::new(), Vec::new());
    write::dump(&mut dump, capture).unwrap();
    write::ltx(&mut list, capture).unwrap();
    let entries = [("waveform.dmp", &dump[..]), ("probes.ltx", &list[..])];
    let (opened, rows) = ila::read_bytes(&ila::archive(&entries), None).unwrap();
    // A net alone does not tell whether it is a bus of one bit.
    let plain = capture.probes.iter().all(|probe| probe.vector == (probe.width > 1));
    assert_same(capture, &opened, &rows, plain);
}

#[test]
fn captures_of_one_three_and_eight_windows_are_read_again() {
    let words = [0x0123_4567_89ab_cdef, 0xffff_ffff_0000_0000, 0x8000_0000_0000_0001];
    let probes = vec![
        probe(0, 128, 0, Radix::Unsigned),
        probe(1, 128, 4, Radix::Signed),
        probe(2, 1, 0, Radix::Hex),
        probe(3, 9, 2, Radix::Binary),
    ];
    for (samples, depth, windows) in [(64, 64, 1), (80, 32, 3), (121, 16, 8)] {
        let capture = capture(probes.clone(), samples, depth, &words);
        assert_eq!(capture.windows.len(), windows);
        check(&capture);
    }
}

proptest! {
    #[test]
    fn any_capture_is_read_again(
        shapes in vec((1u32..200, 0u32..20, 0usize..5), 1..6),
        samples in 1usize..200,
        depth in 1usize..70,
        words in vec(any::<u64>(), 1..40),
    ) {
        let probes = shapes.iter().enumerate().map(|(place, &(width, lsb, radix))| {
            probe(place, width, lsb, RADICES[radix])
        });
        check(&capture(probes.collect(), samples, depth, &words));
    }

    #[test]
    fn any_csv_without_radices_is_read_again_when_its_radix_is_told(
        shapes in vec((1u32..129, 0u32..20), 1..6),
        radix in 0usize..5,
        samples in 1usize..100,
        words in vec(any::<u64>(), 1..40),
    ) {
        let probes = shapes.iter().enumerate().map(|(place, &(width, lsb))| {
            probe(place, width, lsb, RADICES[radix])
        });
        let capture = capture(probes.collect(), samples, 32, &words);
        let (opened, rows) = ila::read_bytes(&csv(&capture, false), Some(RADICES[radix])).unwrap();
        prop_assert_eq!(opened.form, CaptureForm::LegacyCsv);
        assert_same(&capture, &opened, &rows, true);
    }
}
