//! A block of the model beside one of the bench's.

use std::sync::Arc;

use tofsim::Setup;
use tofsim::kernel::Time;
use tofsim_rtl::block::{Block, Mismatch};
use tofsim_rtl::golden::model::Edge;

use crate::held::Held;

pub struct Checker {
    pub block: Block,
}

/// The scenario of a text: its name or path, and in further lines `key=value` overrides.
pub fn setup(text: &str) -> Result<Arc<Setup>, String> {
    let mut lines = text.lines().map(str::trim);
    let name = lines.next().unwrap_or_default();
    let set: Vec<_> = lines.filter(|line| !line.is_empty()).collect();
    Setup::load(name, &set).map(Arc::new).map_err(|error| error.to_string())
}

/// Whether the other side was written by this version.
pub fn check_version(version: &str) -> Result<(), String> {
    let own = env!("CARGO_PKG_VERSION");
    match version == own {
        true => Ok(()),
        false => Err(format!(
            "the SystemVerilog is of tofsim {version}, this library of {own}: write it anew with `tofsim dpi`"
        )),
    }
}

/// What an edge's number in C means; 0 is none, a look only.
pub fn edge(number: i32) -> Result<Option<Edge>, String> {
    match number {
        0 => Ok(None),
        1 => Ok(Some(Edge::Rise)),
        2 => Ok(Some(Edge::Middle)),
        3 => Ok(Some(Edge::Fall)),
        _ => Err(format!("edge {number}: expected 0 (none), 1 (rise), 2 (middle) or 3 (fall)")),
    }
}

/// An instant of the bench's clock [fs].
pub fn instant(time_fs: i64) -> Result<Time, String> {
    match u64::try_from(time_fs) {
        Ok(fs) if fs < u64::MAX / 2 => Ok(Time::from_fs(fs)),
        _ => Err(format!("time {time_fs} fs: expected 0 or more")),
    }
}

impl Checker {
    pub fn new(scenario: &str, block: &str) -> Result<Self, String> {
        let block = Block::new(setup(scenario)?, block).map_err(|error| error.to_string())?;
        Ok(Checker { block })
    }

    /// Whether the bench's port is as wide as the model's.
    pub fn check_port(&self, name: &str, bits: i32) -> Result<(), String> {
        let block = self.block.name();
        let Some(port) = self.block.ports().iter().find(|port| port.name == name) else {
            let names: Vec<_> = self.block.ports().iter().map(|port| port.name.as_str()).collect();
            return Err(format!("{block}.{name}: no such port; there are {}", names.join(", ")));
        };
        match i64::from(bits) == i64::from(port.width) {
            true => Ok(()),
            false => Err(format!(
                "{block}.{name}: the design has {bits} bits, the scenario {}",
                port.width
            )),
        }
    }

    /// Compares outputs just before an edge, and takes it; what differs.
    pub fn step(
        &mut self,
        edge: Option<Edge>,
        now: Time,
        inputs: &[u32],
        outputs: &[u32],
    ) -> Result<Vec<Mismatch>, String> {
        let text = |error: tofsim::error::Error| error.to_string();
        self.block.outputs(now, inputs).map_err(text)?;
        let found = match self.block.is_settled() {
            true => self.block.mismatches(outputs),
            false => Vec::new(),
        };
        if let Some(edge) = edge {
            self.block.edge(edge, now, inputs).map_err(text)?;
        }
        Ok(found)
    }
}

/// Compares and takes an edge; whether all was as it should be. What was not is among the errors.
pub fn step(
    held: &mut Held,
    edge: i32,
    time_fs: i64,
    [inputs, outputs]: [&[u32]; 2],
) -> Result<bool, String> {
    let (edge, now) = (self::edge(edge)?, instant(time_fs)?);
    let checker = held.checker()?;
    let cycle = checker.block.cycle();
    let found = checker.step(edge, now, inputs, outputs)?;
    let block = checker.block.name();
    for Mismatch { port, expected, got } in &found {
        let time = time_fs / 1000;
        held.say(format_args!(
            "{block}: cycle {cycle}, time {time} ps, {port}: expected {expected}, got {got}"
        ));
    }
    Ok(found.is_empty())
}
