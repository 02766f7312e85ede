//! Histograms as estimators take them.

use crate::error::{Input, Result};
use crate::firmware::histogram_builder::Params;

/// Hits per bin, bin 0 first [hits].
pub type Histogram = Vec<u32>;

/// Describes the range of a count.
pub fn count_range(p: &Params) -> String {
    format!("expected a whole number from 0 to {}", p.most_hits())
}

/// Checks that the histogram's total fits the estimator's words.
pub(super) fn checked(
    histogram: Histogram,
    path: &str,
    field: String,
    p: &Params,
) -> Result<Histogram> {
    let (total, most): (u64, u64) =
        (histogram.iter().map(|&count| u64::from(count)).sum(), p.most_hits());
    if total > most {
        let expected = format!("the estimator's bit widths allow {most} hits in all");
        return Err(Input::new(path, expected).field(field).value(total).into());
    }
    Ok(histogram)
}
