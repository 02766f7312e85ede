//! Checks one block: vectors, ports, compilation, run, and a second look where it differs.

use std::path::{Path, PathBuf};
use std::time::Duration;

use tofsim::error::Result;
use tofsim::files::output::create_directory;

use crate::golden::bench::Bench;
use crate::golden::cover::Cover;
use crate::golden::parameters::{NEURONS, Parameter};

use super::data;
use super::interface::Interface;
use super::map::RtlMap;
use super::observed::Observed;
use super::process::Limits;
use super::rtl::Rtl;
use super::simulator::{Compiled, Simulator};
use super::task::Task;
use super::verdict::{Mismatch, Verdict};
use super::wave;

/// What is checked, and how.
#[derive(Clone, Debug)]
pub struct BlockCheck<'a> {
    /// The Verilog.
    pub rtl: &'a Rtl,
    /// How it differs from ours by intention.
    pub map: Option<&'a RtlMap>,
    /// The simulator.
    pub simulator: Simulator,
    /// Whether registers are compared, too.
    pub registers: bool,
    /// Whether what comes before the first reset is compared, too.
    pub from_power_up: bool,
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
    /// What it has not reached, and how many cases of it of how many.
    pub missed: Vec<(&'static str, usize, usize)>,
}

/// A bench that says nothing for so long stands still.
const SILENCE: Duration = Duration::from_secs(15);

impl BlockReport {
    /// Whether the block does not do what it should; one that was not run is not said to.
    pub fn failed(&self) -> bool {
        !matches!(self.verdict, Verdict::Pass | Verdict::NotRun { .. })
    }

    /// Whether it never came to an end.
    pub fn hangs(&self) -> bool {
        matches!(self.verdict, Verdict::Hangs { .. } | Verdict::TimedOut { .. })
    }

    /// Of a block that was not run.
    pub(super) fn not_run(task: &Task, reason: String) -> Self {
        BlockReport {
            name: task.name.clone(),
            cycles: 0,
            verdict: Verdict::NotRun { reason },
            around: Vec::new(),
            wave: None,
            coverage: (0, 0),
            missed: Vec::new(),
        }
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
            Verdict::Hangs { seconds, cycle } => format!(
                "hangs after cycle {cycle}: nothing has moved for {seconds} s, something goes round \
                 without a delay",
            ),
            Verdict::NotRun { reason } => reason.clone(),
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
            Verdict::Hangs { .. } => "hangs",
            Verdict::NotRun { .. } => "not run",
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
    /// When something keeps the check from being made: a missing simulator, module, port or
    /// parameter, Verilog that does not compile, files that cannot be written.
    pub fn run(&self, task: &Task, work: &Path) -> Result<BlockReport> {
        create_directory(work)?;
        let (spec, map) = (task.spec, self.map.map(|map| map.block(task.spec.name)));
        let module = map.as_ref().map_or(spec.name, |map| map.module(spec.name));
        let mut found = self.simulator.interface(work, module, &[], self.rtl, &self.limits)?;
        if let Some(reason) = self.cannot_be(task, module, &found)? {
            return Ok(BlockReport::not_run(task, reason));
        }
        let vectors = (spec.record)(spec, &task.setting)?;
        let set = vectors.parameters.iter().filter_map(|(ours, value)| {
            let theirs = map.as_ref().map_or(Some(*ours), |map| map.parameter(ours))?;
            Some((*ours, theirs, value))
        });
        let names = set.clone().map(|(ours, theirs, _)| (ours, theirs));
        found.check_parameters(&self.rtl.source, [module, spec.name], names)?;
        if let Some(shape) = set.filter_map(shape).next() {
            found = self.simulator.interface(work, module, &[shape], self.rtl, &self.limits)?;
        }
        let wanted = match &map {
            Some(map) => map.wanted(spec, vectors.neurons, &found),
            None => spec.ports(vectors.neurons),
        };
        found.check_ports(&self.rtl.source, module, &wanted)?;

        let mut bench = Bench::new(&vectors);
        let top = vectors.bench_module();
        let mut sources = vec![work.join(&top).with_extension("v")];
        if let Some(map) = &map {
            sources.push(map.apply(&mut bench, spec, &found, work)?);
        }
        bench.write(work)?;
        let compiled =
            self.simulator.compile(work, &top, &sources, self.rtl, self.registers, &self.limits)?;
        let verdict = self.verdict(&compiled, None)?;
        let coverage = vectors.coverage.iter();
        let missed = coverage.clone().filter(|cover| cover.met() < cover.cases());
        let mut report = BlockReport {
            name: task.name.clone(),
            cycles: vectors.stimulus.rows(),
            verdict,
            around: Vec::new(),
            wave: None,
            coverage: (coverage.clone().map(Cover::met).sum(), coverage.map(Cover::cases).sum()),
            missed: missed
                .map(|cover| (cover.what, cover.cases() - cover.met(), cover.cases()))
                .collect(),
        };
        if let Verdict::Differs { first, .. } = report.verdict.clone() {
            self.look_again(&mut report, &compiled, &bench, &first, work)?;
        }
        Ok(report)
    }

    /// Why the design cannot be what the task is about, if it cannot.
    fn cannot_be(&self, task: &Task, module: &str, found: &Interface) -> Result<Option<String>> {
        let Some(configuration) = task.configuration else { return Ok(None) };
        if let Some(other) = configuration.module {
            let block = self.map.map(|map| map.block(other));
            let other = block.as_ref().map_or(other, |block| block.module(other));
            if !self.rtl.has(other)? {
                return Ok(Some(format!("{} has no module {other}", self.rtl.source)));
            }
        }
        let map = self.map.map(|map| map.block(task.spec.name));
        let lacks = |parameter: &&&str| {
            let theirs = map.as_ref().map_or(Some(**parameter), |map| map.parameter(parameter));
            theirs.is_none_or(|theirs| !found.parameters.contains(theirs))
        };
        let missing = configuration.parameters.iter().find(lacks);
        Ok(missing.map(|parameter| format!("module {module} has no parameter {parameter}")))
    }

    fn verdict(&self, compiled: &Compiled, got: Option<&str>) -> Result<Verdict> {
        let mut options = vec!["+progress".to_owned()];
        options.extend(self.from_power_up.then(|| "+from_power_up".to_owned()));
        options.extend(got.map(|name| format!("+got={name}")));
        let limits = Limits { silence: Some(SILENCE), ..self.limits };
        let mut finished = compiled.run(&options, &limits)?;
        if data::bring(&compiled.folder, self.rtl, &finished.output)? {
            finished = compiled.run(&options, &limits)?;
        }
        let verdict = Verdict::read(&finished.output, finished.end);
        if verdict != Verdict::Pass {
            data::check(self.rtl, &finished.output)?;
        }
        Ok(verdict)
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
        let observed = Observed::read(&work.join(GOT), bench, self.registers)?;
        report.around = observed.around(first);
        create_directory(self.output)?;
        wave::write(self.output, &report.name, bench.vectors, &observed, first)?;
        report.wave = Some(self.output.join(format!("{}.vcd", report.name)));
        Ok(())
    }
}

/// The parameter that ports depend on, by their name of it, if it is one.
fn shape<'a>((ours, theirs, value): (&str, &'a str, &Parameter)) -> Option<(&'a str, u64)> {
    match value {
        Parameter::Number(value) if ours == NEURONS => Some((theirs, *value)),
        _ => None,
    }
}
