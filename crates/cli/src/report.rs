//! What a run leaves behind for people and scripts.

pub mod box_plot;
pub mod causes;
pub mod comparison;
pub mod error_plots;
pub mod evaluation;
pub mod evaluation_csv;
pub mod events;
pub mod explanation;
pub mod exploration;
pub mod frame_log;
pub mod histogram_svg;
pub mod learning_curve;
pub mod opinions;
pub mod page;
pub mod pair_table;
pub mod pairs;
pub mod readings;
pub mod run_files;
pub mod statistics;
pub mod summary;
pub mod table;
pub mod timing;
pub mod training;
pub mod verification;
