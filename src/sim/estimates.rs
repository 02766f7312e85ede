//! Depths as the firmware's estimators compute them, bit for bit, without their clock. The network's is
//! [`network::estimate`](crate::network::estimate).

pub mod centroid;
pub mod likelihood;
