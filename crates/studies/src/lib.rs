//! Sweeps: evaluation of a scenario over a parameter grid, and search for the value that just meets a limit.
//!
//! A [`Plan`] defines the values of scenario keys and the quantities to compute at each point. A [`Sweep`] evaluates
//! the points on all cores, keeps each finished one in a journal, and writes a table with one row per point.
//! [`merge`] combines the tables of a sweep's shards.

pub mod columns;
pub mod echo;
pub mod errors;
pub mod figure;
pub mod header;
pub mod images;
pub mod journal;
pub mod limit;
pub mod merge;
pub mod parts;
pub mod plan;
pub mod point;
pub mod shard;
pub mod sweep;
pub mod table;
pub mod tally;
pub mod trial;

pub use plan::Plan;
pub use shard::Shard;
pub use sweep::Sweep;
