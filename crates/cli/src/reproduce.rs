//! The tables and figures of the thesis made again, each with a verdict.

pub mod html;
pub mod item;
mod items;
pub mod json;
mod networks;
mod peaks;
pub mod results;
mod scenes;
mod scopes;
pub mod study;
pub mod text;
mod tradeoffs;
pub mod verdict;

pub use items::all;
