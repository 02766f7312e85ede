//! Clock rates of a design's blocks: measured after place-and-route for an ECP5, estimated from the netlist
//! for a Kintex-7.

pub mod block;
mod delays;
pub mod estimate;
mod netlist;
pub mod nextpnr;
mod paths;
pub mod record;
pub mod resources;
mod synthesis;
pub mod versions;
mod wrapper;

pub use block::{BLOCKS, TimedBlock};
pub use estimate::{Estimate, estimate};
pub use nextpnr::{Measurement, measure};
pub use paths::{Hop, TimedPath};
pub use synthesis::{Part, TimedDesign, own};
