//! Explains why a simulator refuses a design: its first real error, and an option that helps.

use tofsim::error::Input;

use crate::verify::process::Finished;
use crate::verify::rtl::Rtl;

/// Lines of a simulator's message that are passed on.
const LINES: usize = 12;

/// Messages for a missing module, or for none that is left after another error.
const NO_ROOT: [&str; 2] = ["Unable to find the root module", "was not found in design"];

/// Words in a message, and the option that helps.
const HINTS: [(&str, &str); 5] = [
    ("Include file ", "-I DIR names a folder to look in"),
    ("Cannot find include file", "-I DIR names a folder to look in"),
    (NO_MACRO, "-D NAME=VALUE defines a macro"),
    ("Define or directive not defined", "-D NAME=VALUE defines a macro"),
    ("was already declared here", "name the sources one by one, or in a file list (-f)"),
];

/// Icarus's message on an unknown macro before it goes on as if it were empty.
const NO_MACRO: &str = "undefined (and assumed null)";

/// Returns whether it went on without a macro.
pub fn lacks_macro(finished: &Finished) -> bool {
    finished.output.contains(NO_MACRO)
}

/// The error for a module that the sources do not declare.
pub fn no_module(rtl: &Rtl, module: &str) -> Input {
    Input::new(&rtl.source, rtl.lacks(module)).field("module").value(module)
}

/// The error for a run that ended without success; `other_way` says how else such files can be compiled.
pub fn of(
    rtl: &Rtl,
    top: &str,
    finished: &Finished,
    other_way: impl FnOnce() -> Option<&'static str>,
) -> Input {
    let lines = || finished.output.lines();
    let unknown = |line: &str| Some(line.split_once("Unknown module type: ")?.1.to_owned());
    let is_root = |line: &str| NO_ROOT.iter().any(|text| line.contains(text));
    // Icarus's warnings and notes have these words; what it ends with says nothing more.
    let is_noise = |line: &str| {
        if line.contains(NO_MACRO) {
            return false;
        }
        ["warning: ", "error(s) during", "Perhaps ``-s", "No top level modules"]
            .iter()
            .any(|text| line.contains(text))
            || line.starts_with("%Warning") && !line.contains("MODDUP")
            || line.trim().is_empty()
    };
    let errors: Vec<_> = lines()
        .skip_while(|line| is_noise(line))
        .filter(|line| !is_noise(line) && !is_root(line))
        .collect();
    let is_verilators = |line: &&&str| line.starts_with("%Error: Exiting due to");
    let real = errors.iter().filter(|line| !is_verilators(line) && !line.starts_with(' ')).count();
    if real == 0 && lines().any(is_root) {
        return no_module(rtl, top);
    }
    if let Some(module) = lines().find_map(unknown) {
        return no_module(rtl, &module);
    }
    if let Some(why) = finished.end.killed() {
        return Input::new(
            &rtl.source,
            format!("the simulator's compilation {why} (--time-limit)"),
        );
    }
    let hint = lines().find_map(|line| HINTS.iter().find(|(text, _)| line.contains(text)));
    let hint = hint.map(|(_, hint)| *hint).or_else(other_way);
    let hint = hint.map_or(String::new(), |hint| format!(" ({hint})"));
    let message = errors[..errors.len().min(LINES)].join("\n");
    Input::new(&rtl.source, format!("the simulator does not take it{hint}:\n{message}"))
}
