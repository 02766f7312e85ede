//! Benchmark of comparing two large VCD files, relative to reading both with `wellen` in as many threads: `cargo
//! bench --bench compare [-- MEGABYTES]`. It prints both times of each round and the median ratio.
#![allow(clippy::disallowed_methods, reason = "the bench wrote the files")]

use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use wellen::LoadOptions;
use wellen::stream::Filter;

use tofsim_captures::compare::{Options, compare};
use tofsim_captures::source::Source;

/// Default size of each file [MB].
const SIZE: u64 = 200;
const ROUNDS: usize = 5;

/// Writes a VCD of clocks, wires and buses, of which some change at each step. `last` is the final value of one
/// signal.
fn write(path: &Path, megabytes: u64, last: u64) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "$timescale 1ps $end\n$scope module top $end")?;
    let widths: Vec<u32> = (0..128).map(|k| if k < 80 { 1 } else { 1 + (k * 7) % 64 }).collect();
    let id = |k: usize| char::from(b'!' + (k % 90) as u8).to_string() + &"~".repeat(k / 90);
    for (k, width) in widths.iter().enumerate() {
        writeln!(file, "$var wire {width} {} signal_{k} $end", id(k))?;
    }
    writeln!(file, "$upscope $end\n$enddefinitions $end")?;
    let (mut state, mut written, mut at) = (1u64, 0, 0u64);
    let mut draw = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 20
    };
    while written < megabytes * 1_000_000 {
        let mut text = format!("#{at}\n");
        for _ in 0..8 {
            let k = (draw() % 128) as usize;
            let value = draw() & (u64::MAX >> (64 - widths[k]));
            text += &match widths[k] {
                1 => format!("{value}{}\n", id(k)),
                _ => format!("b{value:b} {}\n", id(k)),
            };
        }
        file.write_all(text.as_bytes())?;
        written += text.len() as u64;
        at += 2000;
    }
    writeln!(file, "#{at}\nb{last:b} {}", id(127))?;
    file.flush()
}

/// Measures the time to stream both files, each in a thread.
fn wellen(paths: [&Path; 2]) -> Duration {
    let begun = Instant::now();
    std::thread::scope(|scope| {
        for path in paths {
            scope.spawn(move || {
                let input =
                    BufReader::with_capacity(1 << 17, File::open(path).expect("was written"));
                let options = LoadOptions { multi_thread: false, ..LoadOptions::default() };
                let mut wave = wellen::stream::read(input, &options).expect("is a VCD");
                let mut changes = 0u64;
                let count = wave.stream_changes(Filter::all(), |_, _, _| {
                    changes += 1;
                    Ok::<(), ()>(())
                });
                assert!(count.is_ok() && changes > 0);
            });
        }
    });
    begun.elapsed()
}

fn tofsim(paths: [&Path; 2]) -> Duration {
    let begun = Instant::now();
    let [a, b] = paths.map(|path| Source::file(path, None).expect("is a VCD"));
    let result = compare(&a, &b, &Options::default()).expect("can be compared");
    let differing: Vec<_> = result.differing().map(|pair| pair.differing).collect();
    assert_eq!(differing, [1], "the last value differs and no other");
    begun.elapsed()
}

fn main() -> std::io::Result<()> {
    let size = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(SIZE);
    let folder = tempfile::tempdir()?;
    let paths = [folder.path().join("a.vcd"), folder.path().join("b.vcd")];
    write(&paths[0], size, 1)?;
    write(&paths[1], size, 2)?;
    let paths = [paths[0].as_path(), paths[1].as_path()];
    let mut ratios = Vec::new();
    for round in 0..ROUNDS {
        let (read, compared) = (wellen(paths), tofsim(paths));
        let ratio = read.as_secs_f64() / compared.as_secs_f64();
        let rate = |time: Duration| 2.0 * size as f64 / time.as_secs_f64();
        println!(
            "round {round}: wellen {:.2} s ({:.0} MB/s), compare {:.2} s ({:.0} MB/s), speed {ratio:.2}",
            read.as_secs_f64(),
            rate(read),
            compared.as_secs_f64(),
            rate(compared)
        );
        ratios.push(ratio);
    }
    ratios.sort_by(f64::total_cmp);
    println!("median speed {:.2} of wellen's alone", ratios[ROUNDS / 2]);
    Ok(())
}
