//! Conversion of arguments from the bench.

use std::sync::Arc;

use tofsim::Setup;
use tofsim::kernel::Time;
use tofsim_rtl::golden::model::Edge;

/// Loads a scenario from its name or path, followed by `key=value` overrides in further lines.
pub fn setup(text: &str) -> Result<Arc<Setup>, String> {
    let mut lines = text.lines().map(str::trim);
    let name = lines.next().unwrap_or_default();
    let set: Vec<_> = lines.filter(|line| !line.is_empty()).collect();
    Setup::load(name, &set).map(Arc::new).map_err(|error| error.to_string())
}

/// Checks that the caller was written for this version.
pub fn check_version(version: &str) -> Result<(), String> {
    let own = env!("CARGO_PKG_VERSION");
    if version == own {
        Ok(())
    } else {
        Err(format!(
            "the SystemVerilog is of tofsim {version}, this library of {own}: write it anew with `tofsim dpi`"
        ))
    }
}

/// Converts the C number of an edge; 0 is a comparison without an edge.
pub fn edge(number: i32) -> Result<Option<Edge>, String> {
    match number {
        0 => Ok(None),
        1 => Ok(Some(Edge::Rise)),
        2 => Ok(Some(Edge::Middle)),
        3 => Ok(Some(Edge::Fall)),
        _ => Err(format!("edge {number}: expected 0 (none), 1 (rise), 2 (middle) or 3 (fall)")),
    }
}

/// The bench's time, which does not go back.
#[derive(Default)]
pub struct BenchTime(Time);

impl BenchTime {
    /// Converts a time of the bench [fs].
    pub fn at(&mut self, time_fs: i64) -> Result<Time, String> {
        let Self(last) = self;
        match u64::try_from(time_fs).map(Time::from_fs) {
            Ok(now) if now >= *last && now.fs() < u64::MAX / 2 => {
                *last = now;
                Ok(now)
            }
            _ => Err(format!("time {time_fs} fs: expected {} fs or later", last.fs())),
        }
    }
}
