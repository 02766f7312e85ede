//! Tables, pictures and JUnit.

pub mod junit;
pub mod svg;
pub mod table;
