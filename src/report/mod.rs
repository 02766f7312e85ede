//! What a run leaves behind for people and scripts.

pub mod causes;
pub mod events;
pub mod explanation;
pub mod frame_log;
pub mod histogram_csv;
pub mod histogram_svg;
pub mod products;
pub mod summary;
pub mod table;
