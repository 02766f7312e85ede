//! Rows, columns and banks: how a design scans an array of pixels.

use super::U;

/// Rows that `spad_sel` can select.
pub const MOST_ROWS: u32 = 40;
/// Columns that a design can have.
pub const MOST_COLUMNS: u32 = 64;

/// Number of a row or column of the array.
pub type Place = U<6>;

/// Rows, columns and banks of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scan {
    /// Rows of the array, 1 to [`MOST_ROWS`].
    pub rows: u32,
    /// Columns of the array, 1 to [`MOST_COLUMNS`].
    pub columns: u32,
    /// Banks of histograms, 1 or 2.
    pub banks: u32,
}

impl Default for Scan {
    /// A single pixel.
    fn default() -> Self {
        Scan { rows: 1, columns: 1, banks: 1 }
    }
}

impl Scan {
    /// Returns whether it is a single pixel with one bank.
    pub fn is_single(&self) -> bool {
        *self == Scan::default()
    }

    /// Returns whether there is one histogram only, whose turn it always is.
    #[inline(always)]
    pub fn has_one_histogram(&self) -> bool {
        self.columns * self.banks == 1
    }

    /// Returns whether one bank is read while the other one is filled.
    #[inline(always)]
    pub fn is_banked(&self) -> bool {
        self.banks > 1
    }

    /// Number of the last row.
    #[inline(always)]
    pub fn last_row(&self) -> u64 {
        u64::from(self.rows - 1)
    }

    /// Number of the last column.
    #[inline(always)]
    pub fn last_column(&self) -> u64 {
        u64::from(self.columns - 1)
    }
}
