//! Tables, wrapped text, pictures and JUnit.

pub mod junit;
pub mod svg;
pub mod table;
pub mod wrap;
