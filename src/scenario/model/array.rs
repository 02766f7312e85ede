//! Keys of the array of pixels.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

table! {
    /// The array of pixels, which is read row by row: `spad_sel` selects a row, each of whose pixels has a TDC and a
    /// histogram of its own.
    pub struct Array {
        /// Number of rows. Row 0 is the top, as seen from the sensor.
        #[schemars(range(min = 1, max = 64), extend("unit" = "rows", "source" = "choice: a pixel; the thesis's chip has 40 rows of 30 (Fig. 4.3)"))]
        pub rows: u32 = 1,
        /// Number of columns. Column 0 is on the left, as seen from the sensor.
        #[schemars(range(min = 1, max = 64), extend("unit" = "columns", "source" = "choice: a pixel"))]
        pub columns: u32 = 1,
        /// Banks of histograms in the firmware. With two, a row acquires while the one before is estimated.
        #[schemars(range(min = 1, max = 2), extend("unit" = "banks", "source" = "choice: one, as the thesis's firmware"))]
        pub banks: u32 = 1,
        /// Full angles of the field of view across the middle row and the middle column. Without it, a single pixel
        /// sees the cone of `spad.field_of_view_deg`, and several see the largest rectangle of square pixels inside
        /// the illuminated cone.
        #[schemars(inner(range(min = 0.1, max = 170.0)), extend("unit" = "deg", "source" = "choice: none"))]
        pub field_of_view_deg: Option<[f64; 2]> = None,
        /// Radial distortion of the lens, k1 and k2: a direction at the tangent r from the axis is imaged at
        /// r (1 + k1 r^2 + k2 r^4), as in OpenCV's calibration.
        #[schemars(inner(range(min = -10.0, max = 10.0)), extend("unit" = "1", "source" = "choice: none; Brown, Photogrammetric Engineering 32 (1966)"))]
        pub distortion: [f64; 2] = [0.0; 2],
        /// Additional delay of each pixel's signal path: a CSV file with the columns `row`, `column` and `offset_ps`,
        /// and a line for each pixel. Estimators do not know of it.
        #[schemars(extend("source" = "choice: none"))]
        pub offset_file: Option<String> = None,
        /// Carry chain of each column's TDC: a CSV file with the columns `column`, `profile` (as `tdc.profile`) and
        /// optionally `seed` (in place of that of the profile's `[silicon]`), and a line for each column. Each TDC has the
        /// calibration of its chain, and the likelihood estimator has its bins.
        #[schemars(extend("source" = "choice: none, all have tdc.profile"))]
        pub chains_file: Option<String> = None,
    }
}

impl Array {
    /// Returns the number of pixels.
    pub fn count(&self) -> usize {
        self.rows as usize * self.columns as usize
    }

    /// Returns the number of rows and of columns.
    pub fn size(&self) -> [usize; 2] {
        [self.rows as usize, self.columns as usize]
    }

    /// Returns whether each pixel has a part of a rectangular field of view, and not the cone of a single one.
    pub fn is_rectangular(&self) -> bool {
        self.count() > 1 || self.field_of_view_deg.is_some()
    }
}
