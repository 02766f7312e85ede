//! The tables and figures of the thesis made again, each with a verdict.

pub mod finding;
pub mod html;
pub mod json;
mod line;
mod measured;
mod measures;
mod networks;
mod peaks;
mod published;
mod scenes;
mod scopes;
pub mod study;
mod sweeps;
pub mod table;
pub mod text;
mod values;
pub mod verdict;
