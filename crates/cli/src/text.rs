//! Tables, pictures and JUnit.

pub mod colour;
pub mod junit;
pub mod svg;
pub mod table;
