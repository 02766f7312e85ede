//! Outputs of the selected SPAD row: which are simulated, and which are connected to `tdc_stop`.
//!
//! The thesis's array has 40 rows of 30 SPADs (Fig. 4.3). `spad_sel` stays at row 0, whose outputs reach the FPGA as
//! `spad_out_0` to `spad_out_29`. Output 15 is connected to the TDC; further connected outputs are its neighbours.

use std::ops::Range;

use super::model::Spad;

/// Number of rows of the array.
pub const ROWS: usize = 40;
/// Number of outputs of a row.
pub const OUTPUTS: usize = 30;
/// Number of the selected row.
pub const SELECTED: usize = 0;
/// Output that is always connected to the TDC.
pub const ON_TDC: usize = 15;

/// The outputs of the selected row.
#[derive(Clone, Debug, PartialEq)]
pub struct Wiring {
    /// Outputs that are simulated.
    pub simulated: Range<usize>,
    /// Outputs whose OR drives `tdc_stop`; all of them are simulated.
    pub on_tdc: Range<usize>,
}

impl Wiring {
    /// Returns the wiring of a detector. With n outputs on the TDC these are output 15, (n - 1) / 2 below it (rounded
    /// down) and the rest above it, shifted so that all lie within the row. Without `spad.row_outputs`, only the
    /// connected outputs are simulated, and the row has the thesis's 30 outputs or more if more are connected.
    pub fn of(spad: &Spad) -> Self {
        let (count, row) = (spad.on_tdc as usize, spad.row_outputs as usize);
        let outputs = if row > 0 { row } else { OUTPUTS.max(count) };
        let begin = ON_TDC.saturating_sub((count - 1) / 2).min(outputs.saturating_sub(count));
        let on_tdc = begin..begin + count;
        let simulated = if row > 0 { 0..row } else { on_tdc.clone() };
        Wiring { simulated, on_tdc }
    }

    /// Returns the wiring of a pixel of an array whose row is simulated: the output of each column, that of its own column
    /// on the TDC.
    pub fn of_column(column: usize, columns: usize) -> Self {
        Wiring { simulated: 0..columns, on_tdc: column..column + 1 }
    }

    /// Returns whether some simulated outputs are not connected to the TDC.
    pub fn has_unwired(&self) -> bool {
        self.simulated != self.on_tdc
    }

    /// Returns the positions of the connected outputs among the simulated ones.
    pub fn places(&self) -> Range<usize> {
        let first = self.simulated.start;
        self.on_tdc.start - first..self.on_tdc.end - first
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wiring(on_tdc: u32, row_outputs: u32) -> Wiring {
        Wiring::of(&Spad { on_tdc, row_outputs, ..Spad::default() })
    }

    #[test]
    fn those_on_the_tdc_are_around_output_15_and_in_the_row() {
        for (on_tdc, row_outputs, expected) in [
            (1, 0, 15..16),
            (1, 30, 15..16),
            (2, 30, 15..17),
            (3, 30, 14..17),
            (4, 16, 12..16),
            (29, 30, 1..30),
            (30, 30, 0..30),
            (40, 0, 0..40),
            (40, 64, 0..40),
        ] {
            assert_eq!(wiring(on_tdc, row_outputs).on_tdc, expected, "{on_tdc} of {row_outputs}");
        }
        for row_outputs in 16..=64 {
            for count in 1..=row_outputs.min(40) {
                let found = wiring(count, row_outputs);
                assert_eq!(found.on_tdc.len(), count as usize);
                assert!(found.on_tdc.contains(&ON_TDC) && found.on_tdc.end <= row_outputs as usize);
                assert_eq!(found.has_unwired(), count < row_outputs);
                assert_eq!(found.places(), found.on_tdc);
            }
        }
        let alone = wiring(3, 0);
        assert_eq!((alone.simulated.clone(), alone.places()), (14..17, 0..3));
        assert!(!alone.has_unwired());
    }
}
