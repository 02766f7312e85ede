//! Counts in a simulation of the Verilog.

use std::ffi::{OsStr, OsString};
use std::io::Write;
use std::path::Path;

use crate::error::{Input, Result};
use crate::output::write_file;
use crate::verify::Rtl;
use crate::verify::process::{IVERILOG, Limits, VVP};
use crate::verify::simulator::generation;

use super::seen::Seen;

/// The benches: name of the module, which is the file's stem, and text.
const BENCHES: [(&str, &str); 2] = [
    ("bench_estimator", include_str!("bench_estimator.v")),
    ("bench_shot", include_str!("bench_shot.v")),
];
/// Lines of a compiler's message that are shown.
const SHOWN: usize = 10;

/// Runs the benches on `rtl`.
///
/// # Errors
/// When a tool is missing, the Verilog cannot be compiled with a bench, the simulation does not
/// end, `folder` cannot be written, or the user stops.
pub fn seen(rtl: &Rtl, folder: &Path, limits: &Limits) -> Result<Seen> {
    let mut seen = Seen::default();
    for (name, text) in BENCHES {
        let bench = format!("{name}.v");
        write_file(&folder.join(&bench), |file| file.write_all(text.as_bytes()))?;
        let language = generation(rtl);
        let mut args: Vec<OsString> =
            [language, "-s", name, "-o", "bench.vvp", &bench].map(OsString::from).into();
        args.extend(rtl.files.iter().map(|file| OsStr::new(file).to_owned()));
        let compiled = IVERILOG.run(folder, args, limits)?;
        if !compiled.success {
            return Err(refused(rtl, &compiled.output).into());
        }
        let run = VVP.run(folder, ["-n", "bench.vvp"], limits)?;
        if run.timed_out {
            let seconds = limits.time.as_secs_f64();
            let expected = format!("{name} has not ended after {seconds} s of simulation");
            return Err(Input::new(&rtl.source, expected).into());
        }
        run.output.lines().filter_map(count).for_each(|(key, count)| seen.add(key, count));
    }
    Ok(seen)
}

/// A line `count KEY NUMBER`.
fn count(line: &str) -> Option<(&str, u64)> {
    let (key, number) = line.strip_prefix("count ")?.split_once(' ')?;
    Some((key, number.parse().ok()?))
}

/// What is wrong with Verilog that the compiler refuses.
fn refused(rtl: &Rtl, output: &str) -> Input {
    let unknown = |line: &str| Some(line.split_once("Unknown module type: ")?.1.to_owned());
    let expected = match output.lines().find_map(unknown) {
        Some(module) => format!("it has no module `{module}`"),
        None => {
            let lines: Vec<_> = output.lines().take(SHOWN).collect();
            format!("Icarus Verilog cannot compile it with our bench:\n{}", lines.join("\n"))
        }
    };
    Input::new(&rtl.source, expected)
}
