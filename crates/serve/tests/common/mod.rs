//! A separate server for each test, and clients.

pub mod chromium;
mod server;

pub use server::Server;
