//! Tests of FST files written by tofsim and by `vcd2fst`: valid files are read in every form, and damaged ones are
//! refused with the position of the damage.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tofsim::hierarchy;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::waves::{WaveFormat, Waves};
use tofsim_captures::compare::{Comparison, Options, compare};
use tofsim_captures::source::Source;

use crate::common;

/// Options of `vcd2fst` for each way to compress changes, and the file as a whole.
const FORMS: [&[&str]; 4] = [&["-Z"], &["-F"], &["-4"], &["-4", "-c"]];

/// Writes a run with the given seed as `name`, in the format of its extension.
fn simulated(folder: &Path, name: &str, seed: u64) -> PathBuf {
    let path = folder.join(name);
    let seed = format!("seed={seed}");
    let setup = common::setup("kc705", &["firmware.shots_per_frame=30", &seed]);
    let entries = hierarchy::entries(&setup.params);
    let encoder = &setup.params.tdc.decoder.encoder;
    let format = if name.ends_with("fst") { WaveFormat::Fst } else { WaveFormat::Vcd };
    let waves = Waves::create(&path, format, &entries, encoder, &[]).unwrap();
    let windows = setup.windows(&[], 1).unwrap();
    let watch = Observers { waves: Some((waves, windows)), ..Observers::default() };
    Run::new(&setup).observe(1, watch).unwrap();
    path
}

/// Converts a VCD with `vcd2fst`.
fn converted(vcd: &Path, form: &[&str]) -> PathBuf {
    let fst = vcd.with_extension("twin.fst");
    let done = Command::new("vcd2fst").args(form).arg(vcd).arg(&fst).output();
    let done = done.expect("vcd2fst is missing: apt-get install gtkwave");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    fst
}

fn compared(a: &Path, b: &Path) -> Result<Comparison, String> {
    let [a, b] = [a, b].map(|path| Source::file(path, None).map_err(|error| error.to_string()));
    compare(&a?, &b?, &Options::default()).map_err(|error| error.to_string())
}

#[test]
fn a_run_as_vcd_as_fst_and_as_vcd2fst_packs_it_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let vcd = simulated(folder.path(), "a.vcd", 1);
    let fst = simulated(folder.path(), "a.fst", 1);
    for form in FORMS {
        let result = compared(&fst, &converted(&vcd, form)).unwrap();
        assert!(result.is_same() && result.compared > 1000, "{form:?}: {result:?}");
    }
    assert!(compared(&vcd, &fst).unwrap().is_same());
    let other = simulated(folder.path(), "b.fst", 2);
    assert!(!compared(&vcd, &other).unwrap().is_same());
}

#[test]
fn bytes_that_look_like_the_time_stamps_of_a_vcd_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = simulated(folder.path(), "a.fst", 1);
    let mut bytes = fs::read(&path).unwrap();
    let version = bytes.windows(6).position(|six| six == b"tofsim").unwrap();
    bytes[version..version + 9].copy_from_slice(b"\n#9\n#3\n#x");
    fs::write(&path, bytes).unwrap();
    assert!(compared(&path, &path).unwrap().is_same());
}

/// Returns position and length of each block of a file.
fn blocks(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut blocks = Vec::new();
    let mut begin = 0;
    while begin < bytes.len() {
        let length = u64::from_be_bytes(bytes[begin + 1..begin + 9].try_into().unwrap());
        blocks.push((begin, length as usize));
        begin += 1 + length as usize;
    }
    blocks
}

#[test]
fn a_length_that_leads_nowhere_is_refused_with_its_block() {
    let folder = tempfile::tempdir().unwrap();
    let whole = fs::read(simulated(folder.path(), "a.fst", 1)).unwrap();
    let path = folder.path().join("damaged.fst");
    for (begin, length) in blocks(&whole) {
        for planted in [u64::MAX, u64::MAX - 8, 1 << 48, length as u64 + 1_000_000, 7] {
            let mut bytes = whole.clone();
            bytes[begin + 1..begin + 9].copy_from_slice(&planted.to_be_bytes());
            fs::write(&path, bytes).unwrap();
            let error = compared(&path, &path).unwrap_err();
            let expected = format!("block at byte {begin}: length = {planted}: expected ");
            assert!(error.contains(&expected), "{error}");
        }
    }
}

#[test]
fn a_size_or_count_that_nothing_stands_behind_is_refused_with_its_block() {
    let folder = tempfile::tempdir().unwrap();
    let own = simulated(folder.path(), "a.fst", 1);
    let twin = converted(&simulated(folder.path(), "a.vcd", 1), &["-4"]);
    for file in [own, twin] {
        let whole = fs::read(file).unwrap();
        let path = folder.path().join("damaged.fst");
        let refused = |place: usize, planted: u64| {
            let mut bytes = whole.clone();
            bytes[place..place + 8].copy_from_slice(&planted.to_be_bytes());
            fs::write(&path, bytes).unwrap();
            compared(&path, &path).unwrap_err()
        };
        for (begin, length) in blocks(&whole) {
            let end = begin + 1 + length;
            // The sizes of geometry and names, and the sizes and number of the times.
            let places = match whole[begin] {
                3 => vec![begin + 9, begin + 17],
                4 | 6 | 7 => vec![begin + 9],
                1 | 5 | 8 => vec![end - 24, end - 16, end - 8],
                _ => continue,
            };
            for (place, planted) in places
                .into_iter()
                .flat_map(|place| [1 << 48, 1 << 32, u64::MAX].map(|planted: u64| (place, planted)))
            {
                let error = refused(place, planted);
                let expected = format!("damaged.fst: block at byte {begin}: ");
                assert!(error.contains(&expected) && error.contains("expected "), "{error}");
            }
        }
    }
}

#[test]
fn changes_that_cannot_be_unpacked_are_refused_with_block_and_signal() {
    let folder = tempfile::tempdir().unwrap();
    let own = simulated(folder.path(), "a.fst", 1);
    let whole = fs::read(own).unwrap();
    let path = folder.path().join("damaged.fst");
    let (begin, length) = blocks(&whole).into_iter().find(|(at, _)| whole[*at] == 8).unwrap();
    let mut named = 0;
    for place in (begin + 100..begin + length - 100).step_by(length / 50) {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x10;
        fs::write(&path, bytes).unwrap();
        match compared(&path, &path) {
            Err(error) if error.contains(&format!("block at byte {begin}: ")) => named += 1,
            Err(error) => panic!("{place}: {error}"),
            // Another value, which is nobody's to know.
            Ok(_) => {}
        }
    }
    assert!(named > 3, "{named}");
}
