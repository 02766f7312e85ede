//! A run: the device, the light on it and the acquisition computer, stepped in time.

pub mod array_device;
pub(crate) mod callback;
mod clockwork;
pub(crate) mod cycles;
pub mod device;
pub mod disagreements;
pub mod disturbance;
pub mod domain;
pub mod estimates;
pub mod fast;
pub mod frames;
pub mod free_running;
pub mod image;
mod jitter;
pub mod live;
mod oscillator;
pub mod photons;
mod probe;
mod recordings;
pub mod run;
pub mod second_opinion;
pub mod setup;
pub mod shot_recorder;
pub mod stepped;
pub(crate) mod stepping;
mod tdc_hits;
mod timeline;
pub mod transactions;
mod wave_tracer;

pub use device::Device;
pub use live::{Live, Progress};
pub use run::{Outcome, Run};
pub use stepping::Stepping;
pub use wave_tracer::WindowedProbe;
