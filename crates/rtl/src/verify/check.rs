//! Checks one block: vectors, ports, compilation, run, and a second look where it differs.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory;

use crate::golden::bench::Bench;
use crate::golden::parameters::{NEURONS, Parameter};
use crate::golden::setting::Setting;
use crate::golden::spec::{Spec, Vectors};

use super::interface::{self, Ports};
use super::map::BlockMap;
use super::observed::Observed;
use super::process::Limits;
use super::rtl::Rtl;
use super::simulator::{Compiled, Simulator};
use super::verdict::{Mismatch, Verdict};
use super::vhdl;
use super::wave;

/// What is checked, and how.
#[derive(Clone, Debug)]
pub struct BlockCheck<'a> {
    /// The Verilog.
    pub rtl: &'a Rtl,
    /// How it differs from ours by intention.
    pub map: Option<&'a BlockMap>,
    /// The simulator.
    pub simulator: Simulator,
    /// Whether registers are compared, too.
    pub registers: bool,
    /// When to give up.
    pub limits: Limits<'a>,
    /// Where the waveform of a mismatch goes.
    pub output: &'a Path,
}

/// How a block came out.
#[derive(Clone, Debug)]
pub struct BlockReport {
    /// The block, and what of it if that is not its own bench.
    pub name: String,
    /// Lines compared.
    pub cycles: usize,
    /// How it came out.
    pub verdict: Verdict,
    /// The cycles around the first mismatch, as rows of a table; none without one.
    pub around: Vec<Vec<String>>,
    /// The waveform of both sides.
    pub wave: Option<PathBuf>,
    /// Goals of the stimulus met, and goals.
    pub coverage: (usize, usize),
}

impl BlockReport {
    /// Whether the block does what it should.
    pub fn passed(&self) -> bool {
        self.verdict == Verdict::Pass
    }

    /// What went wrong, in a line; empty if nothing did.
    pub fn fault(&self) -> String {
        match &self.verdict {
            Verdict::Pass => String::new(),
            Verdict::Differs { first, .. } => format!(
                "cycle {}, {} ps: {} expected {}, got {}",
                first.cycle,
                first.time_ps,
                first.signal,
                short(&first.expected),
                short(&first.got),
            ),
            Verdict::TimedOut { seconds } => {
                format!("the bench has not ended in {seconds} s and was killed")
            }
            Verdict::Broke { message } => format!("the bench broke off: {}", message.trim()),
        }
    }

    /// Cycles that differ.
    pub fn mismatches(&self) -> usize {
        match &self.verdict {
            Verdict::Differs { mismatches, .. } => *mismatches,
            _ => 0,
        }
    }

    /// How it came out, in a word or two.
    pub fn word(&self) -> &'static str {
        match self.verdict {
            Verdict::Pass => "pass",
            Verdict::Differs { .. } => "differs",
            Verdict::TimedOut { .. } => "timed out",
            Verdict::Broke { .. } => "broke off",
        }
    }
}

/// A value too long to read, shortened in its middle.
fn short(digits: &str) -> String {
    const LONGEST: usize = 40;
    match (digits.get(..16), digits.len().checked_sub(16).and_then(|end| digits.get(end..))) {
        (Some(head), Some(tail)) if digits.len() > LONGEST => format!("{head}..{tail}"),
        _ => digits.to_owned(),
    }
}

impl BlockCheck<'_> {
    /// Checks a block in `work`, a folder of its own.
    ///
    /// # Errors
    /// When something keeps the check from being made: a missing simulator, module or port,
    /// Verilog that does not compile, files that cannot be written.
    pub fn run(
        &self,
        name: &str,
        spec: &'static Spec,
        setting: &Setting,
        work: &Path,
    ) -> Result<BlockReport> {
        create_directory(work)?;
        let module = self.map.map_or(spec.name, |map| map.module(spec.name));
        let vectors = (spec.record)(spec, setting)?;
        let is_vhdl = self.rtl.has_entity(module);
        if is_vhdl && self.registers {
            let expected = "expected a module in Verilog: the registers of VHDL have no names here";
            return Err(Input::new("--registers", expected).value(module).into());
        }
        let rtl = self.verilog(spec, module, &vectors, setting.neurons(), work)?;
        let shape: Vec<_> = shape(&vectors, self.map).filter(|_| !is_vhdl).collect();
        let found = self.simulator.ports(work, module, &shape, &rtl, &self.limits)?;
        let wanted = match self.map {
            Some(map) => map.wanted(spec, setting.neurons(), &found),
            None => spec.ports(setting.neurons()),
        };
        interface::check(&self.rtl.source, module, &wanted, &found)?;

        let mut bench = Bench::new(&vectors);
        bench.fixed = is_vhdl;
        let top = vectors.bench_module();
        let mut sources = vec![work.join(&top).with_extension("v")];
        if let Some(map) = self.map {
            sources.push(map.apply(&mut bench, spec, &found, work)?);
        }
        bench.write(work)?;
        let compiled =
            self.simulator.compile(work, &top, &sources, &rtl, self.registers, &self.limits)?;
        let verdict = self.verdict(&compiled, None)?;
        let mut report = BlockReport {
            name: name.to_owned(),
            cycles: vectors.stimulus.rows(),
            verdict,
            around: Vec::new(),
            wave: None,
            coverage: vectors
                .coverage
                .iter()
                .fold((0, 0), |(met, goals), cover| (met + cover.met(), goals + cover.cases())),
        };
        if let Verdict::Differs { first, .. } = report.verdict.clone() {
            self.look_again(&mut report, &compiled, &bench, &first, work)?;
        }
        Ok(report)
    }

    /// The design, with Verilog for its VHDL.
    fn verilog(
        &self,
        spec: &Spec,
        module: &str,
        vectors: &Vectors,
        neurons: usize,
        work: &Path,
    ) -> Result<Cow<'_, Rtl>> {
        let theirs = |ours| self.map.map_or(ours, |map| map.parameter(ours));
        let generics = vectors.parameters.iter().map(|(ours, value)| (theirs(ours), value));
        let generics: Vec<_> = generics.filter(|(name, _)| !name.is_empty()).collect();
        let ports = match self.map {
            Some(map) => map.wanted(spec, neurons, &Ports::new()),
            None => spec.ports(neurons),
        };
        let names: Vec<_> = ports.into_iter().map(|port| port.name).collect();
        vhdl::as_verilog(self.rtl, module, &generics, &names, work, &self.limits)
    }

    fn verdict(&self, compiled: &Compiled, got: Option<&str>) -> Result<Verdict> {
        let finished = compiled.run(got, &self.limits)?;
        let limit = finished.timed_out.then_some(self.limits.time.as_secs());
        Ok(Verdict::read(&finished.output, limit))
    }

    /// Runs once more to see everything, for the table and the waveform.
    fn look_again(
        &self,
        report: &mut BlockReport,
        compiled: &Compiled,
        bench: &Bench,
        first: &Mismatch,
        work: &Path,
    ) -> Result<()> {
        const GOT: &str = "got.mem";
        self.verdict(compiled, Some(GOT))?;
        let observed = Observed::read(&work.join(GOT), bench)?;
        report.around = observed.around(first);
        create_directory(self.output)?;
        wave::write(self.output, &report.name, bench.vectors, &observed, first)?;
        report.wave = Some(self.output.join(format!("{}.vcd", report.name)));
        Ok(())
    }
}

/// The parameter that ports depend on, by their name of it, if they have one.
fn shape<'a>(
    vectors: &'a Vectors,
    map: Option<&'a BlockMap>,
) -> impl Iterator<Item = (&'a str, u64)> {
    vectors.parameters.iter().filter_map(move |(ours, value)| {
        let Parameter::Number(value) = value else { return None };
        let theirs = map.map_or(*ours, |map| map.parameter(ours));
        (*ours == NEURONS && !theirs.is_empty()).then_some((theirs, *value))
    })
}
