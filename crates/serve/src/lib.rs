//! The acquisition computer of the thesis (section 2.4) as a page in a browser on this computer.
//!
//! One thread simulates (a pixel, or the images of an array), or talks to a board ([`session`], driven by [`engine`]); others answer browsers ([`http`]). All browsers see the
//! same run.

pub mod engine;
pub mod http;
pub mod options;
pub mod served;
pub mod session;

pub use options::{Fidelity, Options};
