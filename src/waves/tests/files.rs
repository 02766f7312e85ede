//! Tests of waveform files as such: windows, times, provenance, full disks.

use std::fs;
use std::io;

use wellen::simple::read;

#[cfg(unix)]
use crate::files::output::device;
use crate::firmware::tof_top::Pins;
use crate::firmware::tof_top::TofTop;
use crate::hierarchy::{entries, ram_entries};
use crate::kernel::Time;

use super::super::writer::WaveFormat;
use super::bench::{Bench, params};
use super::readback::{FORMATS, FRAME, at, contents, create, extension, record};

#[test]
fn outside_the_windows_everything_is_unknown() {
    let directory = tempfile::tempdir().unwrap();
    let (whole, parts) = (directory.path().join("whole"), directory.path().join("parts"));
    fs::create_dir_all(&whole).unwrap();
    fs::create_dir_all(&parts).unwrap();
    let whole = contents(&mut read(&record(&whole, false, params())[0]).unwrap());
    let [open, end, again] = [260, 300, 330].map(|cycle| 8000 * cycle);
    for path in record(&parts, true, params()) {
        let parts = contents(&mut read(&path).unwrap());
        for (path, (width, changes)) in &parts {
            let (unknown, whole) = ("x".repeat(*width as usize), &whole[path].1);
            for time in [0, open - 1, end, again - 1] {
                assert_eq!(at(changes, time), unknown, "{path} at {time}");
            }
            for time in (open..end).chain(again..again + 100_000).step_by(500) {
                assert_eq!(at(changes, time), at(whole, time), "{path} at {time}");
            }
        }
    }
}

#[test]
fn windows_that_touch_are_one() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.vcd");
    let params = params();
    let mut waves = [create(&path, WaveFormat::Vcd, &entries(&params), &params)];
    let mut bench = Bench::new(params);
    waves[0].begin(bench.now(), &bench.top);
    bench.run(10, &mut waves);
    waves[0].end(bench.now());
    waves[0].begin(bench.now(), &bench.top);
    bench.run(10, &mut waves);
    waves[0].end(bench.now());
    let [waves] = waves;
    waves.finish(bench.now()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(text.matches("$dump").count(), 1);
    assert!(text.ends_with("#160000\n"));
}

#[test]
fn a_file_says_where_it_comes_from() {
    let directory = tempfile::tempdir().unwrap();
    let paths = record(directory.path(), true, params());
    let text = fs::read_to_string(&paths[0]).unwrap();
    let header = text.split_once("$enddefinitions").unwrap().0;
    assert!(header.contains("scenario kc705") && header.contains("seed 1"));
    assert!(header.contains("$timescale 1 ps $end") && !header.contains("$date"));
    let fst = read(&paths[1]).unwrap();
    assert!(fst.hierarchy().version().ends_with("; scenario kc705; seed 1"));
    assert_eq!(fst.hierarchy().timescale().unwrap().unit.to_exponent(), Some(-12));
}

#[test]
fn a_sample_without_a_change_writes_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    let entries = [entries(&params), ram_entries(&Default::default())].concat();
    let mut bench = Bench::new(params.clone());
    for _ in 0..FRAME - 100 {
        bench.cycle(&mut |_, _| ());
    }
    let size = |extra: u64| {
        let path = directory.path().join("run.vcd");
        let mut waves = create(&path, WaveFormat::Vcd, &entries, &params);
        waves.begin(Time::ZERO, &TofTop::default());
        for k in 1..=1 + extra {
            waves.sample(Time::from_ns(k), &bench.top);
        }
        waves.finish(Time::from_ns(9)).unwrap();
        fs::read(&path).unwrap()
    };
    assert_eq!(size(0), size(5));
}

#[test]
fn time_is_rounded_down_and_never_goes_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.vcd");
    let params = params();
    let mut waves = create(&path, WaveFormat::Vcd, &entries(&params), &params);
    let mut top = TofTop::default();
    waves.begin(Time::ZERO, &top);
    for fs in [5_999, 6_000, 6_999, 4_000] {
        top.pins.tdc_stop = !top.pins.tdc_stop;
        waves.sample(Time::from_fs(fs), &top);
    }
    waves.finish(Time::from_fs(5_000)).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let stamps: Vec<_> = text.lines().filter(|line| line.starts_with('#')).collect();
    assert_eq!(stamps, ["#0", "#5", "#6"]);
}

#[test]
fn an_unfinished_waveform_leaves_nothing_behind() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    for format in FORMATS {
        let path = directory.path().join("run").with_extension(extension(format));
        let mut waves = create(&path, format, &entries(&params), &params);
        waves.begin(Time::ZERO, &TofTop::default());
        drop(waves);
    }
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_that_names_the_file_now_and_later() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let params = params();
        let mut waves = create(&device(folder.path(), "full"), format, &entries(&params), &params);
        let mut bench = Bench::new(params);
        waves.begin(Time::ZERO, &bench.top);
        let mut first = None;
        for _ in 0..6 * FRAME {
            bench.cycle(&mut |now, top| {
                waves.sample(now, top);
                if let Err(error) = waves.check() {
                    first.get_or_insert(error.to_string());
                }
            });
        }
        assert_eq!(first.is_some(), format == WaveFormat::Vcd, "VCD is written as it goes");
        let last = waves.finish(bench.now()).unwrap_err().to_string();
        assert!(last.contains("full: cannot write") && last.contains("space"), "{last}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_that_cannot_seek_is_written_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let params = params();
        let waves = create(&device(folder.path(), "null"), format, &entries(&params), &params);
        waves.finish(Time::from_ns(1)).unwrap();
    }
}

#[test]
fn a_single_instant_and_the_end_of_the_run_are_kept() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    for format in FORMATS {
        for end in [0, 9] {
            let path = directory.path().join("run").with_extension(extension(format));
            let mut waves = create(&path, format, &entries(&params), &params);
            let pins = Pins { rst: true, ..Pins::default() };
            waves.begin(Time::ZERO, &TofTop { pins, ..TofTop::default() });
            waves.finish(Time::from_ns(end)).unwrap();
            let mut wave = read(&path).unwrap();
            let last = *wave.time_table().last().unwrap();
            assert!(last == 1000 * end || (end == 0 && last <= 1), "{format:?}");
            assert_eq!(at(&contents(&mut wave)["tof_top.rst"].1, 0), "1");
        }
    }
}

#[test]
fn a_file_with_a_gap_is_not_put_in_place() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    for format in FORMATS {
        let path = directory.path().join("run").with_extension(extension(format));
        let mut waves = create(&path, format, &entries(&params), &params);
        waves.begin(Time::ZERO, &TofTop::default());
        waves.failed = Some(io::Error::new(io::ErrorKind::StorageFull, "no space then"));
        let error = waves.finish(Time::from_ns(1)).unwrap_err().to_string();
        assert!(error.contains("no space then") && !path.exists(), "{error}");
    }
}
