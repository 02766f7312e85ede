//! Values of options, as they are written.

use tofsim::kernel::Time;

/// Most samples that a signal may be late.
const LONGEST_LATENCY: u64 = 65_536;

/// A time with its unit.
pub(super) fn time(text: &str) -> std::result::Result<Time, String> {
    tofsim_captures::compare::time(text)
        .ok_or_else(|| "expected a time, as 10us or 8.5ns".to_owned())
}

/// A signal and what is said of it.
pub(super) fn setting<T: std::str::FromStr>(
    text: &str,
) -> std::result::Result<(String, T), String> {
    let fault = || format!("expected SIGNAL=VALUE with a {}", kind::<T>());
    let (name, value) = text.split_once('=').ok_or_else(fault)?;
    Ok((name.to_owned(), value.parse().map_err(|_| fault())?))
}

/// A signal and by how many samples it is late.
pub(super) fn latency(text: &str) -> std::result::Result<(String, i64), String> {
    let (name, samples) = setting::<i64>(text)?;
    match samples.unsigned_abs() <= LONGEST_LATENCY {
        true => Ok((name, samples)),
        false => Err(format!("expected {LONGEST_LATENCY} samples at most")),
    }
}

/// What the value of a setting has to be.
fn kind<T>() -> &'static str {
    match std::any::type_name::<T>() {
        "u64" => "whole number from 0",
        "i64" => "whole number",
        _ => "signal",
    }
}
