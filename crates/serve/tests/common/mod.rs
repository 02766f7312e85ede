//! A server of its own for each test, and who asks it.

pub mod chromium;
mod server;

pub use server::Server;
