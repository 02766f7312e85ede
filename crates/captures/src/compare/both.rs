//! Both sides and what differs in one waveform, with set-ups for GTKWave and Surfer.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use vcd::{IdCode, TimescaleUnit, Writer};

use tofsim::error::{Input, Result};
use tofsim::files::output::{OutputFile, write_file};

use super::bits::Bits;
use super::pair::Pair;
use super::result::Comparison;
use super::view::{SCOPES, TOP, View, flat};

/// The waveform, being written.
pub(super) struct Both {
    file: OutputFile,
    /// For each pair its signals in the three scopes.
    codes: Vec<[IdCode; 3]>,
    /// High while any pair differs.
    any: IdCode,
    widths: Vec<u32>,
    wrong: Vec<bool>,
    /// Pairs that differ now, and whether the file says that some do.
    count: usize,
    shown: Option<bool>,
    first: Option<u64>,
    last: Option<u64>,
}

impl Both {
    /// Begins the waveform at `path`, which has to end in `.vcd`.
    pub(super) fn create(path: &Path, pairs: &[Pair]) -> Result<Both> {
        if path.extension().is_none_or(|extension| extension != "vcd") {
            let expected = "expected a name that ends in .vcd";
            return Err(Input::new("--waves", expected).value(path.display()).into());
        }
        let mut both = Both {
            file: OutputFile::create(path)?,
            codes: vec![[IdCode::FIRST; 3]; pairs.len()],
            any: IdCode::FIRST,
            widths: pairs.iter().map(|pair| pair.width).collect(),
            wrong: vec![false; pairs.len()],
            count: 0,
            shown: None,
            first: None,
            last: None,
        };
        both.header(pairs).map_err(|error| both.file.fault(error))?;
        Ok(both)
    }

    fn header(&mut self, pairs: &[Pair]) -> io::Result<()> {
        let mut vcd = Writer::new(&mut self.file);
        vcd.version(concat!("tofsim ", env!("CARGO_PKG_VERSION")))?;
        vcd.timescale(1, TimescaleUnit::PS)?;
        vcd.add_module(TOP)?;
        for (scope, name) in SCOPES.iter().enumerate() {
            vcd.add_module(name)?;
            for (pair, codes) in pairs.iter().zip(&mut self.codes) {
                let width = if scope == 2 { 1 } else { pair.width };
                codes[scope] = vcd.add_wire(width, &flat(&pair.name))?;
            }
            vcd.upscope()?;
        }
        self.any = vcd.add_wire(1, "any_differs")?;
        vcd.upscope()?;
        vcd.enddefinitions()
    }

    /// Changes that follow are at this time [ps].
    pub(super) fn at(&mut self, ps: u128) -> Result<()> {
        let ps = u64::try_from(ps).unwrap_or(u64::MAX);
        self.go_to(ps).map_err(|error| self.file.fault(error))
    }

    fn go_to(&mut self, ps: u64) -> io::Result<()> {
        if self.last == Some(ps) {
            return Ok(());
        }
        self.sum_up()?;
        self.first.get_or_insert(ps);
        self.last = Some(ps);
        Writer::new(&mut self.file).timestamp(ps)
    }

    /// Says whether any pair differs, as of the last time.
    fn sum_up(&mut self) -> io::Result<()> {
        let now = Some(self.count > 0);
        if self.last.is_some() && now != self.shown {
            self.shown = now;
            Writer::new(&mut self.file).change_scalar(self.any, self.count > 0)?;
        }
        Ok(())
    }

    /// The values of a pair change.
    pub(super) fn change(&mut self, pair: usize, sides: [&Bits; 2], differs: bool) -> Result<()> {
        self.write(pair, sides, differs).map_err(|error| self.file.fault(error))
    }

    fn write(&mut self, pair: usize, sides: [&Bits; 2], differs: bool) -> io::Result<()> {
        let (codes, width) = (self.codes[pair], self.widths[pair]);
        let mut vcd = Writer::new(&mut self.file);
        for (bits, code) in sides.into_iter().zip(codes) {
            match width {
                1 => vcd.change_scalar(code, bits.level(0))?,
                _ => vcd.change_vector(code, (0..width).rev().map(|bit| bits.level(bit)))?,
            }
        }
        vcd.change_scalar(codes[2], differs)?;
        self.count += usize::from(differs);
        self.count -= usize::from(self.wrong[pair]);
        self.wrong[pair] = differs;
        Ok(())
    }

    /// Puts the waveform in place, with its set-ups beside it; their paths.
    pub(super) fn finish(mut self, result: &Comparison) -> Result<Vec<PathBuf>> {
        self.sum_up().map_err(|error| self.file.fault(error))?;
        let path = self.file.target().to_owned();
        self.file.commit()?;
        if !std::fs::metadata(&path).is_ok_and(|found| found.is_file()) {
            return Ok(vec![path]);
        }
        let (save, commands) = (path.with_extension("gtkw"), path.with_extension("sucl"));
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let view = View::new(result, (self.first.unwrap_or(0), self.last.unwrap_or(0)));
        write_file(&save, |file| file.write_all(view.gtkwave(&name).as_bytes()))?;
        write_file(&commands, |file| file.write_all(view.surfer().as_bytes()))?;
        Ok(vec![path, save, commands])
    }
}
