//! The tables and figures of the thesis made again, each with a verdict.

pub mod finding;
pub mod html;
mod measures;
mod networks;
mod peaks;
mod published;
mod scenes;
pub mod study;
mod sweeps;
pub mod table;
pub mod text;
mod values;
pub mod verdict;
