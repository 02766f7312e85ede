//! The histogram as the estimator reads it.

use std::fmt::Write;

use tofsim::error::{Input, Result};
use tofsim::hierarchy::TOP;

use crate::compare::Probed;
use crate::source::Source;

/// Number of bins that an error lists.
const LISTED: usize = 4;

/// Bin counts of a histogram, as far as they are known.
pub(super) type Words = Vec<Option<u64>>;

/// Reads the bin counts that the estimator reads, the first value of each if they differ; `None` if its readout is
/// not probed.
///
/// # Errors
/// If the capture cannot be read.
pub(super) fn readout(
    probed: &mut Probed,
    bins: usize,
    notes: &mut Vec<String>,
) -> Result<Option<Words>> {
    let port = |name: &str| probed.probe(&format!("{TOP}.{name}"));
    let (Some(valid), Some(bin), Some(count)) =
        (port("hist_valid"), port("hist_bin"), port("hist_count"))
    else {
        return Ok(None);
    };
    let mut words = vec![None; bins];
    let mut others = false;
    while probed.next()?.is_some() {
        if probed.value(valid) != Some(1) {
            continue;
        }
        let (Some(bin), Some(count)) = (probed.value(bin), probed.value(count)) else { continue };
        if let Some(word) = words.get_mut(bin as usize) {
            let first = *word.get_or_insert(count);
            others |= first != count;
        }
    }
    if others {
        notes.push("the words differ from frame to frame; the first of each is taken".to_owned());
    }
    Ok(Some(words))
}

/// Formats a histogram as CSV.
///
/// # Errors
/// If a bin count is unknown.
pub(super) fn list(capture: &Source, words: &Words) -> Result<String> {
    let missing: Vec<String> =
        (0..words.len()).filter(|&bin| words[bin].is_none()).map(|bin| bin.to_string()).collect();
    if !missing.is_empty() {
        let list = missing[..missing.len().min(LISTED)].join(", ");
        let expected = format!(
            "{} of {} words of the histogram are never read in it ({list}, ...); let it begin \
             before the estimator does",
            missing.len(),
            words.len()
        );
        return Err(Input::new(&capture.name, expected).into());
    }
    let mut list = "bin,count\n".to_owned();
    for (bin, count) in words.iter().enumerate() {
        let _ = writeln!(list, "{bin},{}", count.unwrap_or(0));
    }
    Ok(list)
}
