//! Sweeps: a scenario at many points, what comes of each, and where a limit is just met.
//!
//! A [`Plan`] says which keys of a scenario take which values, and what is wanted of each point. A [`Sweep`] works the
//! points out on all cores, keeps each finished one in a journal, and in the end writes a table of one row a point.
//! [`merge`] makes one table of those of a sweep's shards.

pub mod columns;
pub mod echo;
pub mod errors;
pub mod figure;
pub mod header;
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
