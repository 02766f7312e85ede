//! A histogram as CSV: `bin,count`, 256 rows.

use std::io;

use crate::firmware::histogram_builder::BINS;

/// Writes one histogram.
pub fn write(out: impl io::Write, histogram: &[u16; BINS]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(["bin", "count"])?;
    for (bin, count) in histogram.iter().enumerate() {
        csv.write_record([bin.to_string(), count.to_string()])?;
    }
    csv.flush()
}
