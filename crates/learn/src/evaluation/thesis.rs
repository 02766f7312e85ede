//! The thesis's figures, to lie beside ours.

/// Distances of its tables [m].
pub const DISTANCES_M: [f64; 6] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];

/// A row of a table: mean error and twice the standard deviation at each distance [mm].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// Name and place in the thesis.
    pub name: &'static str,
    /// Mean of the estimated less the true distance [mm].
    pub mean_mm: [f64; 6],
    /// Twice the standard deviation [mm].
    pub two_sd_mm: [f64; 6],
}

/// The network in double precision.
pub const FLOAT: Published = Published {
    name: "thesis, float (Table 5.5)",
    mean_mm: [0.0, -0.1, 0.0, 0.0, -0.2, 0.1],
    two_sd_mm: [1.6, 2.8, 3.3, 2.9, 3.5, 4.9],
};

/// The network in the hardware, ten histograms a distance.
pub const FIXED: Published = Published {
    name: "thesis, fixed point (Table 6.5)",
    mean_mm: [0.0, -2.2, -2.1, 1.6, -3.4, -3.3],
    two_sd_mm: [5.6, 7.4, 10.0, 18.9, 4.6, 11.2],
};

/// Peak detection, where it found one peak.
pub const PEAK: Published = Published {
    name: "thesis, peak detection (Table 5.2)",
    mean_mm: [-5.7, 2.2, 3.9, 3.6, 0.7, -2.3],
    two_sd_mm: [12.0, 10.2, 9.6, 10.0, 10.0, 9.5],
};

/// Failures of peak detection among [`PEAK_TRIALS`] histograms a distance (Table 4.3).
pub const PEAK_FAILURES: [u64; 6] = [0, 0, 0, 7, 332, 2584];
/// See [`PEAK_FAILURES`].
pub const PEAK_TRIALS: u64 = 30_000;

/// [`FLOAT`]'s spread, straight between its distances, from 0.1 to 0.6 m [mm].
pub fn line_two_sd_mm(distance_m: f64) -> f64 {
    let place = ((distance_m - DISTANCES_M[0]) / 0.1).clamp(0.0, 5.0);
    let below = (place as usize).min(4);
    let line = FLOAT.two_sd_mm;
    line[below] + (place - below as f64) * (line[below + 1] - line[below])
}

/// The error that the specification allows (Table 5.2, "requested error"): 10 mm, and 5 % of the distance
/// from 0.2 m on. Beyond the table's 0.1 to 0.6 m it goes on in the same way, which is our reading [mm].
pub fn allowed_error_mm(distance_m: f64) -> f64 {
    (50.0 * distance_m).max(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specification_goes_through_the_table() {
        for (distance_m, allowed_mm) in
            DISTANCES_M.into_iter().zip([10.0, 10.0, 15.0, 20.0, 25.0, 30.0])
        {
            assert!((allowed_error_mm(distance_m) - allowed_mm).abs() < 1e-9);
        }
    }

    #[test]
    fn the_line_goes_through_the_table() {
        for (distance_m, two_sd_mm) in DISTANCES_M.into_iter().zip(FLOAT.two_sd_mm) {
            assert!((line_two_sd_mm(distance_m) - two_sd_mm).abs() < 1e-9);
        }
        assert!((line_two_sd_mm(0.15) - 2.2).abs() < 1e-9);
        assert_eq!(line_two_sd_mm(0.7), 4.9);
    }
}
