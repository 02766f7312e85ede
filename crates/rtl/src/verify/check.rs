//! Checks one block: vectors, ports, compilation, run, and a second look where it differs.

use std::path::Path;
use std::time::Duration;

use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory;

use crate::golden::bench::Bench;
use crate::golden::cover::Cover;

use super::candidate::{Candidate, Dut};
use super::data;
use super::observed::Observed;
use super::process::{End, Limits, Overrun};
use super::report::BlockReport;
use super::simulator::Compiled;
use super::task::Task;
use super::verdict::{Mismatch, Verdict};
use super::wave;

/// Subject and strictness of a check.
#[derive(Clone, Debug)]
pub struct BlockCheck<'a> {
    /// The design, and what it is checked with.
    pub dut: Dut<'a>,
    /// True if registers are compared, too.
    pub registers: bool,
    /// True if what comes before the first reset is compared, too.
    pub from_power_up: bool,
    /// True if a bench ends at its first mismatch, without a second look.
    pub first_only: bool,
    /// Folder for the waveform of a mismatch.
    pub output: &'a Path,
}

/// A bench that says nothing for so long stands still.
const SILENCE: Duration = Duration::from_secs(15);

/// Rate at which a simulator reads the lines, before it prints anything; Verilator reads 9 MB/s, a busy
/// machine less [B/s].
const READING: u64 = 2_000_000;

impl BlockCheck<'_> {
    /// Checks a block in `work`, a folder of its own.
    ///
    /// # Errors
    /// When something keeps the check from being made: a missing simulator, module, port or
    /// parameter, Verilog that does not compile, files that cannot be written.
    pub fn run(&self, task: &Task, work: &Path) -> Result<BlockReport> {
        create_directory(work)?;
        let vectors = (task.spec.record)(task.spec, &task.setting)?;
        let candidate = match Candidate::find(&self.dut, task, &vectors, work)? {
            Ok(candidate) => candidate,
            Err(reason) => {
                return Ok(BlockReport::without_run(&task.name, Verdict::NotRun { reason }));
            }
        };
        if candidate.fixed && self.registers {
            let expected = "expected a module in Verilog: the registers of VHDL have no names here";
            return Err(Input::new("--registers", expected).value(task.spec.name).into());
        }
        let mut bench = Bench::new(&vectors);
        bench.fixed = candidate.fixed;
        bench.past = candidate.past;
        let top = vectors.bench_module();
        let mut sources = vec![work.join(&top).with_extension("v")];
        if let Some(map) = &candidate.map {
            sources.push(map.apply(&mut bench, task.spec, &candidate.found, work)?);
        }
        bench.write(work)?;
        let (rtl, registers) = (&candidate.rtl, self.registers);
        let compiled =
            self.dut.simulator.compile(work, &top, &sources, rtl, registers, &self.dut.limits)?;
        let verdict = self.verdict(&compiled, None)?;
        let coverage = vectors.coverage.iter();
        let missed = coverage.clone().filter(|cover| cover.met() < cover.cases());
        let mut report = BlockReport {
            name: task.name.clone(),
            cycles: vectors.stimulus.rows(),
            verdict,
            around: Vec::new(),
            open: candidate.open,
            wave: None,
            coverage: (coverage.clone().map(Cover::met).sum(), coverage.map(Cover::cases).sum()),
            missed: missed
                .map(|cover| (cover.what, cover.cases() - cover.met(), cover.cases()))
                .collect(),
        };
        if let (Verdict::Differs { first, .. }, false) = (report.verdict.clone(), self.first_only) {
            self.look_again(&mut report, &compiled, &bench, &first, work)?;
        }
        Ok(report)
    }

    fn verdict(&self, compiled: &Compiled, got: Option<&str>) -> Result<Verdict> {
        let mut options = vec!["+progress".to_owned()];
        options.extend(self.from_power_up.then(|| "+from_power_up".to_owned()));
        options.extend(self.first_only.then(|| "+first".to_owned()));
        options.extend(got.map(|name| format!("+got={name}")));
        let lines = compiled.folder.join("expected.mem").metadata().map_or(0, |file| file.len());
        let silence = Some(SILENCE + Duration::from_secs(lines / READING));
        let limits = Limits { silence, ..self.dut.limits };
        let mut finished = compiled.run(&options, &limits)?;
        if data::bring(&compiled.folder, self.dut.rtl, &finished.output)? {
            finished = compiled.run(&options, &limits)?;
        }
        if let (End::OutOfTime(Overrun::Clock(_)), Some(why)) =
            (finished.end, finished.end.killed())
        {
            // Nor is it the design's fault.
            return Err(Input::new(&self.dut.rtl.source, format!("the bench {why}")).into());
        }
        let verdict = Verdict::read(&finished.output, finished.end);
        if verdict != Verdict::Pass {
            data::check(self.dut.rtl, &finished.output)?;
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
