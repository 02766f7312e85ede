//! Counts in a simulation of the Verilog.

use std::path::Path;

use tofsim::error::{Input, Result};
use tofsim::files::output::write_bytes;

use crate::verify::process::Limits;
use crate::verify::rtl::Rtl;
use crate::verify::simulator::Simulator;

use super::design::{CountedDesign, with_defines};
use super::measured::Measured;
use super::promises::Promise;

/// The bench of an estimator: the part of its own between the head and the tail that all have.
macro_rules! of_estimator {
    ($own:literal) => {
        concat!(include_str!("bench_head.v"), include_str!($own), include_str!("bench_tail.v"))
    };
}

/// The benches: name of the module, which is the file's stem, and text.
const BENCHES: [(&str, &str); 5] = [
    ("bench_estimator", of_estimator!("bench_estimator.v")),
    ("bench_shot", include_str!("bench_shot.v")),
    ("bench_scan", include_str!("bench_scan.v")),
    ("bench_centroid", of_estimator!("bench_centroid.v")),
    ("bench_likelihood", of_estimator!("bench_likelihood.v")),
];

/// Returns the benches that show those promises: name and text.
pub fn benches(promises: &[Promise]) -> impl Iterator<Item = (&'static str, &'static str)> {
    let is_needed =
        |(name, _): &(&str, &str)| promises.iter().any(|it| it.properties.bench == *name);
    BENCHES.into_iter().filter(is_needed)
}

/// Counts what is promised of `rtl`, which is to be such a design, in the benches that show it.
///
/// # Errors
/// When a tool is missing, the Verilog cannot be compiled with a bench, the simulation does not
/// end, `folder` cannot be written, or the user stops.
pub fn measure(
    promises: &[Promise],
    rtl: &Rtl,
    design: &CountedDesign,
    folder: &Path,
    limits: &Limits,
) -> Result<Measured> {
    let mut measured = Measured::default();
    for (name, text) in benches(promises) {
        let bench = format!("{name}.v");
        write_bytes(&folder.join(&bench), with_defines(name, &design.defines(), text))?;
        let bench = [folder.join(bench)];
        let compiled = Simulator::Icarus.compile(folder, name, &bench, rtl, false, limits)?;
        let run = compiled.run(&[], limits)?;
        if let Some(why) = run.end.killed() {
            return Err(Input::new(&rtl.source, format!("{name} {why}")).into());
        }
        run.output.lines().filter_map(count).for_each(|(key, count)| measured.add(key, count));
    }
    Ok(measured)
}

/// A line `count KEY NUMBER`.
fn count(line: &str) -> Option<(&str, u64)> {
    let (key, number) = line.strip_prefix("count ")?.split_once(' ')?;
    Some((key, number.parse().ok()?))
}
