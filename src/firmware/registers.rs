//! Registers of the host.

pub mod map;
