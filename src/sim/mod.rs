//! A run: the device, the light on it and the acquisition computer, stepped in time.

pub mod acquisition;
pub mod centroid;
pub mod device;
pub mod frames;
pub mod histogram;
pub mod jitter;
pub mod leap;
pub mod many;
pub mod oscillator;
pub mod recorder;
pub mod run;
pub mod setup;
mod sinks;
pub mod timeline;
mod trace;
mod tracer;

pub use acquisition::Gait;
pub use device::Device;
pub use run::{Outcome, Run};
pub use tracer::Windowed;
