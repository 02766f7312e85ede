//! A run: the device, the light on it and the acquisition computer, stepped in time.

pub mod cycles;
pub mod device;
pub mod fast;
pub mod frames;
pub mod jitter;
pub mod oscillator;
mod probe;
pub mod run;
pub mod setup;
pub mod shot_recorder;
mod sinks;
pub mod timeline;
mod wave_tracer;

pub use device::Device;
pub use fast::Stepping;
pub use run::{Outcome, Run};
pub use wave_tracer::WindowedProbe;
