//! The detector and the light that reaches it, as avalanches in time.

pub(crate) mod light;
pub mod photon_list;
pub mod spad;
pub mod streams;
