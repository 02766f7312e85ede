//! What a network estimates from.

use crate::firmware::histogram_builder::BINS;

/// Hits per bin, bin 0 first [hits].
pub type Histogram = [u16; BINS];

/// Most hits a histogram may hold; the widths of the estimator's words bear any such sum [hits].
pub const MAX_HITS: u32 = 65_535;
