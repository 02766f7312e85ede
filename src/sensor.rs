//! The detector and its illumination, as a process of avalanches in time.

mod blocks;
pub mod front_end;
pub mod light;
pub mod optics;
pub mod photon_list;
pub mod ring;
pub mod row;
pub mod row_light;
pub mod shaper;
pub mod spad;
pub mod streams;
