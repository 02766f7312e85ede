//! The detector and the light that reaches it, as avalanches in time.

pub mod front_end;
pub mod light;
pub mod photon_list;
pub mod ring;
pub mod row;
pub mod shaper;
pub mod spad;
pub mod streams;
