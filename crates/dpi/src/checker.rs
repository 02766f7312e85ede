//! A model block that runs in parallel with the bench's block.

use tofsim_rtl::block::{Block, Mismatch};

use crate::arguments::{self, BenchTime};

pub struct Checker {
    pub block: Block,
    /// Mask of the next step's output bits that are neither 0 nor 1.
    pub unknown: Vec<u32>,
    /// Comparisons so far.
    pub compared: u64,
    time: BenchTime,
}

impl Checker {
    pub fn new(scenario: &str, block: &str) -> Result<Self, String> {
        let block =
            Block::new(arguments::setup(scenario)?, block).map_err(|error| error.to_string())?;
        Ok(Checker { block, unknown: Vec::new(), compared: 0, time: BenchTime::default() })
    }

    /// Checks that the bench's port has the width of the model's.
    pub fn check_port(&self, name: &str, bits: i32) -> Result<(), String> {
        let block = self.block.name();
        let Some(port) = self.block.ports().iter().find(|port| port.name == name) else {
            let names: Vec<_> = self.block.ports().iter().map(|port| port.name.as_str()).collect();
            return Err(format!("{block}.{name}: no such port; there are {}", names.join(", ")));
        };
        if i64::from(bits) == i64::from(port.width) {
            Ok(())
        } else {
            Err(format!("{block}.{name}: the design has {bits} bits, the scenario {}", port.width))
        }
    }

    /// Takes a change of `tdc_stop`.
    pub fn stop(&mut self, time_fs: i64, level: bool) -> Result<(), String> {
        self.block.stop(self.time.at(time_fs)?, level);
        Ok(())
    }

    /// Returns the model's outputs just before an edge.
    pub fn outputs(&mut self, time_fs: i64, inputs: &[u32]) -> Result<&[u32], String> {
        let now = self.time.at(time_fs)?;
        self.block.outputs(now, inputs).map_err(|error| error.to_string())
    }

    /// Compares outputs just before an edge, processes the edge, and returns a message for each output that differs.
    pub fn step(
        &mut self,
        edge: i32,
        time_fs: i64,
        [inputs, outputs]: [&[u32]; 2],
    ) -> Result<Vec<String>, String> {
        let (edge, now, cycle) =
            (arguments::edge(edge)?, self.time.at(time_fs)?, self.block.cycle());
        let text = |error: tofsim::error::Error| error.to_string();
        self.block.outputs(now, inputs).map_err(text)?;
        let found = if self.block.is_settled() {
            self.compared += 1;
            self.block.mismatches(outputs, &self.unknown)
        } else {
            Vec::new()
        };
        self.unknown.clear();
        if let Some(edge) = edge {
            self.block.edge(edge, now, inputs).map_err(text)?;
        }
        let (block, time) = (self.block.name(), time_fs / 1000);
        let sentence = |Mismatch { port, expected, got }| {
            format!(
                "{block}: cycle {cycle}, time {time} ps, {port}: expected {expected}, got {got}"
            )
        };
        Ok(found.into_iter().map(sentence).collect())
    }
}
