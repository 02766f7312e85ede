//! Why an instrument has no likelihood estimator.

/// Why there is no estimator for an instrument.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unfit {
    /// The pulse is too short for the bins.
    #[error("a pulse of {0} bins standard deviation, expected a half or more")]
    Short(f64),
    /// The pulse does not fit into the window.
    #[error("a pulse {0} bins long, expected {1} at most")]
    Long(usize, usize),
    /// Bins end later than a word can say.
    #[error("bins that end {0} bins late")]
    Late(f64),
    /// A bin is too wide.
    #[error("a bin {0:.1} bins wide, expected less than 16")]
    Wide(f64),
    /// The window is longer than a depth can say.
    #[error("a window of {0:.1} m, expected {1} at most")]
    Far(f64, f64),
    /// The cover glass sends more light than a word can say.
    #[error("a pedestal of {0:.1} photons a shot, expected {1} at most")]
    Bright(f64, f64),
}
