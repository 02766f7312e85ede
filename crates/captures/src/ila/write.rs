//! Writer of captures in Vivado's formats: CSV, VCD, and the archive that contains both.

mod archive;
mod csv;
mod dump;
mod ltx;
mod spill;
mod vcd;

pub use archive::archive;
pub use csv::csv;
pub(crate) use csv::write_cell;
pub use dump::dump;
pub use ltx::ltx;
pub use vcd::vcd;
