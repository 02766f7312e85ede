//! Writes captures as Vivado writes them: CSV, VCD, and the archive that holds both.

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
