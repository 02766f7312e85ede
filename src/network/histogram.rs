//! Histograms as estimators take them.

/// Hits per bin, bin 0 first [hits].
pub type Histogram = Vec<u32>;
