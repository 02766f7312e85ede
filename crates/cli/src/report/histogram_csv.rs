//! A histogram as CSV: `bin,count`, 256 rows.

use tofsim::firmware::histogram_builder::BINS;

/// The text of the file.
pub fn text(histogram: &[u16; BINS]) -> Vec<u8> {
    let rows = histogram.iter().enumerate().map(|(bin, count)| format!("{bin},{count}\n"));
    ["bin,count\n".to_owned()].into_iter().chain(rows).collect::<String>().into_bytes()
}
