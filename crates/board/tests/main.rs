//! The client, against a device in software.

mod client;
mod device;
mod files;
mod laser;
mod lines;
