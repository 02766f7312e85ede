//! What people and other programs read: tables and pictures.

pub mod svg;
pub mod table;
