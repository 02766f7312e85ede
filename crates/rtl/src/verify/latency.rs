//! Latencies of a map that no design can have, or that leave nothing to compare.

use tofsim::error::{Input, Result};

use crate::golden::bench::allowances::Allowances;
use crate::golden::spec::{FIRST_RESET, Latency, Vectors};

use super::map::BlockMap;

impl BlockMap {
    /// Checks that no output comes before the input that it depends on, and that something is left to compare.
    ///
    /// # Errors
    /// Names the entry of the map.
    pub(super) fn check_latencies(&self, vectors: &Vectors, allowed: &Allowances) -> Result<()> {
        let block = vectors.spec.name;
        for (output, &clocks) in &self.latency {
            let Some(earliest) = earliest(output, vectors) else { continue };
            if clocks < earliest {
                let expected = format!(
                    "expected at least {earliest}: {block} has {output} {} clocks after the input that \
                     it depends on",
                    -earliest,
                );
                let field = format!("block.{block}.latency.{output}");
                return Err(Input::new(&self.source, expected).field(field).value(clocks).into());
            }
        }
        let (lines, after) = (vectors.stimulus.rows(), allowed.quiet_after_first());
        let earliest = allowed.delays.values().copied().min().unwrap_or(0).min(0);
        let is_late_or_early = after - earliest > 0;
        if is_late_or_early && FIRST_RESET as i64 + after - earliest >= lines as i64 {
            let expected = format!(
                "expected latency and settle that leave some of {lines} clock cycles to compare; \
                 increase --cycles",
            );
            let field = format!("block.{block}");
            return Err(Input::new(&self.source, expected).field(field).into());
        }
        Ok(())
    }
}

/// The least latency that an output can have beside ours: where it follows its input without a register. None if it
/// is not known.
fn earliest(output: &str, vectors: &Vectors) -> Option<i64> {
    let clocks = |latency: &Latency| (latency.cycles)(vectors) as i64;
    let all = vectors.spec.latency;
    let own = all.iter().filter(|latency| latency.to == output).map(clocks).min();
    // Of a block whose effects all take one clock, the others' do too.
    let others =
        || (!all.is_empty() && all.iter().all(|latency| clocks(latency) == 0)).then_some(0);
    Some(-own.or_else(others)? - 1)
}
