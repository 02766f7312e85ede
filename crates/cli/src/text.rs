//! What people and other programs read: tables, pictures and JUnit.

pub mod colour;
pub mod junit;
pub mod svg;
pub mod table;
