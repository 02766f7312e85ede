//! Execution of a peer, and parsing of its output.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::Result;

/// A frame of a peer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PeerFrame {
    /// Depth word of the estimator, 36 bits.
    pub depth: u64,
    /// Number of shots in the frame.
    pub shots: u64,
    /// Number of the edge of clk_sys at which `algo_done` rose.
    pub edge: u64,
}

/// Output of a run.
#[derive(Clone, Debug)]
pub struct Output {
    /// Frames.
    pub frames: Vec<PeerFrame>,
    /// Time of the frames [s].
    pub seconds: f64,
}

/// Runs a driver, which times itself (`protocol.h`).
pub fn driver(command: &mut Command) -> Result<Output> {
    let text = stdout(command)?;
    let seconds = text.lines().find_map(|line| line.strip_prefix("seconds ")).unwrap_or("");
    let seconds = seconds.parse().map_err(|_| format!("{command:?} told no time"))?;
    Ok(Output { frames: frames(&text)?, seconds })
}

/// Runs Icarus, and measures the time from its line `begin` to its end.
pub fn vvp(command: &mut Command) -> Result<Output> {
    let mut child = command.stdout(Stdio::piped()).spawn()?;
    let (mut text, mut begun) = (String::new(), None);
    for line in child.stdout.take().into_iter().flat_map(|pipe| BufReader::new(pipe).lines()) {
        let line = line?;
        if line == "begin" {
            begun = Some(Instant::now());
        }
        text = text + &line + "\n";
    }
    let status = child.wait()?;
    let seconds = begun.map(|begun| begun.elapsed().as_secs_f64());
    match seconds {
        Some(seconds) if status.success() => Ok(Output { frames: frames(&text)?, seconds }),
        _ => Err(format!("vvp failed ({status})\n{text}").into()),
    }
}

/// Returns the standard output of a successful command.
pub fn stdout(command: &mut Command) -> Result<String> {
    let output = command.output().map_err(|fault| format!("cannot run {command:?}: {fault}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(text);
    }
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines: Vec<_> = text.lines().chain(complaint.lines()).collect();
    let errors = lines.iter().filter(|line| line.to_lowercase().contains("error")).take(5);
    let errors: Vec<_> = errors.map(|line| line.to_string()).collect();
    let program = command.get_program().display();
    Err(format!("{program} failed ({})\n{}", output.status, errors.join("\n")).into())
}

fn frames(text: &str) -> Result<Vec<PeerFrame>> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("frame "));
    lines
        .map(|line| frame(line).ok_or_else(|| format!("cannot read frame {line}").into()))
        .collect()
}

fn frame(line: &str) -> Option<PeerFrame> {
    let mut words = line.split_whitespace();
    Some(PeerFrame {
        depth: u64::from_str_radix(words.next()?, 16).ok()?,
        shots: words.next()?.parse().ok()?,
        edge: words.next()?.parse().ok()?,
    })
}
