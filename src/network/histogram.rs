//! What a network estimates from.

/// Hits per bin, bin 0 first [hits].
pub type Histogram = Vec<u32>;
