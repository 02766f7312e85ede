//! Versions of the machine and its tools.

use std::fs;
use std::process::Command;
use std::sync::OnceLock;

use serde_json::{Value, json};

/// Returns the first line that a command prints; `None` if the command is missing.
pub fn first_line(program: &str, argument: &str) -> Option<String> {
    let output = Command::new(program).arg(argument).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().next().map(str::to_owned)
}

/// Returns the processor model.
pub fn cpu() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name"));
    model.map_or("unknown".into(), |rest| rest.trim_start_matches([' ', '\t', ':']).to_owned())
}

/// Returns the versions of the compilers.
pub fn compilers() -> &'static [Option<String>] {
    static FOUND: OnceLock<Vec<Option<String>>> = OnceLock::new();
    FOUND.get_or_init(|| {
        let calls = [("verilator", "--version"), ("iverilog", "-V"), ("g++", "--version")];
        calls.map(|(program, argument)| first_line(program, argument)).to_vec()
    })
}

/// Returns all versions, for the report.
pub fn json() -> Value {
    let [verilator, iverilog, gxx] = compilers() else { return Value::Null };
    json!({
        "tofsim": env!("CARGO_PKG_VERSION"),
        "verilator": verilator,
        "iverilog": iverilog,
        "g++": gxx,
        "rustc": first_line("rustc", "--version"),
    })
}
