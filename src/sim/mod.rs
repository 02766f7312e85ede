//! A run: the device, the light on it and the acquisition computer, stepped in time.

pub mod device;
pub mod frames;
pub mod jitter;
pub mod recorder;
pub mod run;
pub mod setup;
pub mod timeline;
mod trace;
mod tracer;
pub mod window;

pub use device::Device;
pub use run::{Outcome, Run};
pub(crate) use tracer::Windowed;
