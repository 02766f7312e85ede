//! Values of options, as they are written.

use std::str::FromStr;

use tofsim::kernel::Time;

/// Most samples that a signal may be late.
const LONGEST_LATENCY: u64 = 65_536;

/// A time with its unit.
pub(crate) fn time(text: &str) -> Result<Time, String> {
    tofsim_captures::compare::time(text)
        .ok_or_else(|| "expected a time, as 10us or 8.5ns".to_owned())
}

/// A signal and what is said of it, which has to be of that kind.
fn setting<T: FromStr>(text: &str, kind: &str) -> Result<(String, T), String> {
    let fault = || format!("expected SIGNAL=VALUE with a {kind}");
    let (name, value) = text.split_once('=').ok_or_else(fault)?;
    Ok((name.to_owned(), value.parse().map_err(|_| fault())?))
}

/// A signal and by how much it may differ.
pub(super) fn tolerance(text: &str) -> Result<(String, u64), String> {
    setting(text, "whole number from 0")
}

/// A signal and the one that says where it counts.
pub(super) fn valid(text: &str) -> Result<(String, String), String> {
    setting(text, "signal")
}

/// A signal and by how many samples it is late.
pub(super) fn latency(text: &str) -> Result<(String, i64), String> {
    let (name, samples) = setting::<i64>(text, "whole number")?;
    if samples.unsigned_abs() <= LONGEST_LATENCY {
        Ok((name, samples))
    } else {
        Err(format!("expected {LONGEST_LATENCY} samples at most"))
    }
}
