//! Tests with planted faults of tests/mutants.list: a bench of golden vectors and a checker find each fault at the
//! same place.

use std::path::PathBuf;

use rayon::prelude::*;

use tofsim::Setup;
use tofsim_rtl::golden::bench::Bench;
use tofsim_rtl::golden::{Setting, blocks};

use super::common::{Run, compile, design, root, run, write};

/// Blocks whose vectors use ROMs or a calibration that the scenario does not have.
const OTHERS: [&str; 7] = [
    "tdc_calibration",
    "tdc_decoder",
    "code_preload",
    "histogram_preload",
    "forward1",
    "forward2",
    "tansig",
];

/// A fault: the file, the surrounding text, and its replacement.
#[derive(Clone, Debug)]
struct Fault {
    file: String,
    anchor: String,
    old: String,
    new: String,
}

impl Fault {
    fn read(line: &str) -> Option<Self> {
        let (place, edit) = line.split_once(": ")?;
        let (old, new) = edit.split_once(" ->")?;
        let (file, anchor) = place.split_once(" after ").unwrap_or((place, ""));
        let file = file.split_once(" in ").map_or(file, |(file, _configuration)| file);
        let [file, anchor, old, new] = [file, anchor, old, new.trim_start()].map(str::to_owned);
        Some(Fault { file, anchor, old, new })
    }

    fn block(&self) -> &str {
        self.file.trim_end_matches(".v")
    }

    fn plant(&self) -> String {
        let text = std::fs::read_to_string(root().join("rtl_ref").join(&self.file)).unwrap();
        let from = text.find(&self.anchor).unwrap() + self.anchor.len();
        let at = from + text[from..].find(&self.old).unwrap();
        [&text[..at], &self.new, &text[at + self.old.len()..]].concat()
    }
}

/// Returns the KC705's faults that a bench can detect, in blocks whose vectors use the scenario's ROMs.
fn faults() -> Vec<Fault> {
    let list = std::fs::read_to_string(root().join("tests/mutants.list")).unwrap();
    let own = list.lines().take_while(|line| !line.starts_with("scenario: "));
    let lines = own.filter(|line| !line.starts_with('#') && !line.contains(" ~ equivalent"));
    let faults = lines.filter_map(Fault::read);
    // A host's blocks have no checker.
    let has_checker =
        |fault: &Fault| blocks::find(fault.block()).is_some_and(|it| it.model.is_some());
    let faults = faults.filter(has_checker);
    faults.filter(|fault| !OTHERS.contains(&fault.block())).collect()
}

/// Returns the cycle number at the start of a line.
fn cycle(line: &str) -> &str {
    line.split_once(',').unwrap().0
}

/// Returns cycle, port, expected and actual value of the mismatches in the first cycle that has one; `of` parses a
/// line.
fn first<'a>(run: &'a Run, of: impl Fn(&'a str) -> Option<&'a str>) -> Vec<String> {
    let lines: Vec<_> = run.text.lines().filter_map(of).collect();
    let same = lines.iter().filter(|line| cycle(line) == cycle(lines[0]));
    // Times differ: a bench looks 1 ps before an edge.
    let without_time = |line: &&str| {
        let (cycle, rest) = line.split_once(", time ").unwrap();
        format!("{cycle}, {}", rest.split_once(" ps, ").unwrap().1)
    };
    same.map(without_time).collect()
}

/// Returns whether the bench and the checker detect a fault, if they agree.
fn seen(fault: &Fault) -> Result<bool, String> {
    let (spec, folder) = (blocks::find(fault.block()).unwrap(), tempfile::tempdir().unwrap());
    // As many shots as the block's vectors have; of the whole, a frame as the scenario has it.
    let (set, as_configured): (&[&str], _) = match spec.name {
        "frame_ctrl" => (&["firmware.shots_per_frame=3"], false),
        "tof_top" => (&["firmware.shots_per_frame=60"], true),
        _ => (&[], false),
    };
    let setting = Setting { as_configured, ..Setting::new(Setup::load("kc705", set).unwrap()) };
    let vectors = (spec.record)(spec, &setting).unwrap();
    Bench::new(&vectors).write(folder.path()).unwrap();
    write(folder.path(), ("kc705", set), Some(&[spec.name]));
    let planted = folder.path().join(&fault.file);
    std::fs::write(&planted, fault.plant()).unwrap();
    let is_other = |path: &PathBuf| path.file_name() != planted.file_name();
    let mut files: Vec<_> = design().into_iter().filter(is_other).collect();
    files.extend([planted.clone(), folder.path().join(vectors.bench_module() + ".v")]);
    let program = compile(folder.path(), &vectors.bench_module(), &files, &[]);
    let power_up = ["+from_power_up", "+tofsim_from_power_up"];
    let bench =
        run(&program, folder.path(), &[&power_up[..], &["+first", "+tofsim_go_on"]].concat());
    let own = format!("{}: cycle ", spec.name);
    let checker = run(&program, folder.path(), &power_up);
    let wanted = first(&bench, |line| line.strip_prefix("mismatch: cycle "));
    let found = first(&checker, |line| line.split_once(&own).map(|(_, rest)| rest));
    let stops = checker.text.contains("is not as the model has it");
    let agree = found.iter().all(|line| wanted.contains(line))
        && (found.len() == wanted.len() || spec.timing.samples() > 1);
    match (wanted.is_empty(), found.is_empty(), stops) {
        (true, true, false) => Ok(false),
        (false, false, true) if agree => Ok(true),
        _ => Err(format!("{fault:?}:\nbench {wanted:#?}\nchecker {found:#?}")),
    }
}

/// Plants every `every`th fault, and asserts that at least `least` are detected.
fn plant(every: usize, least: usize) {
    let faults: Vec<_> = faults().into_iter().step_by(every).collect();
    let seen: Vec<_> = faults.par_iter().map(seen).collect();
    let wrong: Vec<_> = seen.iter().filter_map(|seen| seen.as_ref().err()).cloned().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let count = seen.iter().filter(|seen| **seen == Ok(true)).count();
    println!("{count} of {} faults are seen at ports", faults.len());
    assert!(count >= least, "{count} of {} are seen at ports", faults.len());
}

#[test]
#[ignore = "long: ./check --full"]
fn a_checker_stops_at_a_fault_where_the_bench_of_the_block_does() {
    plant(20, 14);
}

#[test]
fn a_checker_stops_where_a_fault_is() {
    plant(130, 2);
}
