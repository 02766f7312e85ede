//! The network's numbers in other formats: networks from elsewhere, other datapaths, and what each
//! rounding costs.

pub mod datapath;
pub mod explain;
pub mod export;
pub mod import;

pub use explain::{Explanation, explain};
