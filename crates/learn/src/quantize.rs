//! The network's numbers in other formats: networks from elsewhere, other datapaths, and what each
//! rounding costs.

pub mod circuit;
pub mod datapath;
pub mod explain;
pub mod export;
pub mod import;

pub use circuit::Circuit;
pub use datapath::Datapath;
pub use explain::{Explanation, explain};
