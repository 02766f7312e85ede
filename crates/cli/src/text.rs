//! What people and other programs read: tables, pictures and JUnit.

pub mod junit;
pub mod svg;
pub mod table;
