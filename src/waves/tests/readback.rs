//! Test helpers that write waveforms and read them with the independent library `wellen`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use wellen::simple::Waveform;

use crate::firmware::tof_top::Params;
use crate::hierarchy::{Entry, entries, ram_entries};

use super::super::writer::{WaveFormat, Waves};
use super::bench::{Bench, SHOTS};

pub const FORMATS: [WaveFormat; 2] = [WaveFormat::Vcd, WaveFormat::Fst];
/// Slightly more than the length of a frame [cycles of clk_sys].
pub const FRAME: u64 = 256 + 6 * SHOTS as u64 + 16 + 268 + 20;

pub fn extension(format: WaveFormat) -> &'static str {
    match format {
        WaveFormat::Vcd => "vcd",
        WaveFormat::Fst => "fst",
    }
}

/// Creates a waveform file with some provenance.
pub fn create(path: &Path, format: WaveFormat, entries: &[Entry], params: &Params) -> Waves {
    let provenance = ["scenario kc705".to_owned(), "seed 1".to_owned()];
    Waves::create(path, format, entries, &params.tdc.decoder.encoder, &provenance).unwrap()
}

/// Records the run that most tests examine, from time 0 on or in two windows.
pub fn record(directory: &Path, windows: bool, params: Params) -> Vec<PathBuf> {
    let entries = [entries(&params), ram_entries(&Default::default())].concat();
    let paths = FORMATS.map(|format| directory.join("run").with_extension(extension(format)));
    let mut waves: Vec<_> = FORMATS
        .iter()
        .zip(&paths)
        .map(|(&format, path)| create(path, format, &entries, &params))
        .collect();
    let mut bench = Bench::new(params);
    let parts = if windows { vec![260, 40, 30, FRAME] } else { vec![0, FRAME] };
    for (part, cycles) in parts.into_iter().enumerate() {
        for waves in &mut waves {
            match part % 2 {
                0 => waves.end(bench.now()),
                _ => waves.begin(bench.now(), &bench.top),
            }
        }
        bench.run(cycles, &mut waves);
    }
    for waves in waves {
        waves.finish(bench.now()).unwrap();
    }
    paths.to_vec()
}

/// Path, width and changes of each signal: time [ps] and digits, where the last entry of a time applies.
pub type Contents = BTreeMap<String, (u32, Vec<(u64, String)>)>;

/// Reads all signals of a file.
pub fn contents(wave: &mut Waveform) -> Contents {
    let variables: Vec<_> = wave.hierarchy().all_vars().collect();
    let references: Vec<_> = variables.iter().map(|&var| var.deref_in(wave).signal_ref()).collect();
    wave.load_signals(&references);
    let times = wave.time_table().to_vec();
    let mut contents = Contents::new();
    for var in variables {
        let var = var.deref_in(wave);
        let signal = wave.get_signal(var.signal_ref()).unwrap();
        let mut changes: Vec<(u64, String)> = Vec::new();
        for (index, value) in signal.iter_changes() {
            let change = (times[index as usize], value.to_bit_string().unwrap());
            changes.pop_if(|last| last.0 == change.0);
            changes.push(change);
        }
        let width = var.length(wave.hierarchy()).unwrap();
        contents.insert(var.full_name(wave.hierarchy()), (width, changes));
    }
    contents
}

/// Lookup of a variable.
pub trait DerefIn {
    /// Returns the variable in `wave`.
    fn deref_in(self, wave: &Waveform) -> &wellen::Var;
}

impl DerefIn for wellen::VarRef {
    fn deref_in(self, wave: &Waveform) -> &wellen::Var {
        &wave.hierarchy()[self]
    }
}

/// Asserts that two files are equal, and reports only the first difference.
pub fn assert_same(one: &Contents, other: &Contents) {
    assert!(one.keys().eq(other.keys()));
    for (path, (width, changes)) in one {
        let (other_width, others) = &other[path];
        let differs = changes.iter().zip(others).find(|(a, b)| a != b);
        assert_eq!(differs, None, "{path}");
        assert_eq!((width, changes.len()), (other_width, others.len()), "{path}");
    }
}

/// Returns the value at a time [ps].
pub fn at(changes: &[(u64, String)], time: u64) -> &str {
    let after = changes.partition_point(|change| change.0 <= time);
    &changes[after - 1].1
}
