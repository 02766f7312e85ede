//! tofsim: a cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder.
//!
//! Light by a link budget sets off avalanches in a detector. The firmware, register by register as its
//! Verilog has it, turns them into a histogram, and the histogram into metres with the weights of a
//! trained network. The same scenario and seed give the same bits.
//!
//! | to ... | take |
//! |---|---|
//! | choose what is measured, with what light, sensor and firmware | [`Setup::load`], [`Scenario`] |
//! | get frames: depth, histogram, counts | [`Run::frames`], [`Frame`] |
//! | see each shot, write a waveform, or stop on the way | [`Run::observe`], [`Observers`], [`Setup::waves`] |
//! | step cycle by cycle and read signals by name | [`Run::step_cycles`] |
//! | go faster where nobody looks at signals | [`Run::stepping`], [`Stepping`], [`Run::many`], [`HistogramRun`] |
//! | know how much light comes back | [`Budget`], `setup.budget` |
//! | estimate a depth without a run | [`Setup::estimate`], [`Network`] |
//! | know whether a frame's depth is valid | [`SecondOpinion`] |
//!
//! # A frame
//!
//! A scenario is built in, as `kc705`, or a TOML file; every key can be overridden.
//!
//! ```
//! use tofsim::{Run, Setup};
//!
//! # fn main() -> tofsim::Result<()> {
//! let setup = Setup::load("kc705", &["target.distance_m=0.3"])?;
//! for frame in Run::new(&setup).frames(2)? {
//!     println!("{:.4} m from {} hits", frame.depth_m(), frame.hits());
//!     # assert!((frame.depth_m() - 0.3).abs() < 0.05);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Cycle by cycle
//!
//! A function is called at every edge of `clk_sys`, and has the values of the signals that it asks for
//! by name. It ends the run when it likes.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use tofsim::{Run, Setup};
//!
//! # fn main() -> tofsim::Result<()> {
//! let setup = Setup::load("kc705", &[])?;
//! let signals = ["tof_top.tdc_valid", "tof_top.tdc_code"];
//! let mut codes = Vec::new();
//! Run::new(&setup).step_cycles(1, signals, |cycle, [valid, code]| {
//!     if valid == 1 {
//!         println!("{}: code {code}", cycle.begin);
//!         codes.push(code);
//!     }
//!     Ok(if codes.len() < 8 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
//! })?;
//! # assert_eq!(codes.len(), 8);
//! # Ok(())
//! # }
//! ```
//!
//! # A custom estimator
//!
//! The crate `tofsim-learn` has the panel of estimators, and evaluates them over many scenes; its example
//! `own_estimator` adds one. A run's histograms alone are enough to begin with:
//!
//! ```
//! use tofsim::{Histogram, Run, Setup};
//!
//! /// The middle of the fullest bin [m].
//! fn fullest_bin_m(histogram: &Histogram) -> f64 {
//!     let fullest = (0..histogram.len()).max_by_key(|&bin| histogram[bin]).unwrap_or_default();
//!     (fullest as f64 + 0.5) * 25e-12 * 299_792_458.0 / 2.0
//! }
//!
//! # fn main() -> tofsim::Result<()> {
//! let setup = Setup::load("kc705", &[])?;
//! for frame in Run::new(&setup).frames(1)? {
//!     println!("{:.4} m, the network says {:.4}", fullest_bin_m(&frame.histogram), frame.depth_m());
//!     # assert!((fullest_bin_m(&frame.histogram) - 0.5).abs() < 0.1);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Where to find what
//!
//! The folder `examples/` has these as programs. What each key of a scenario means is said by
//! `tofsim scenario schema`, what the blocks do by `docs/model.md`, and how the crate is laid out by
//! `docs/architecture.md`. Modules that this page does not list are for the crates beside this one; they
//! may change at any time.

#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod error;
#[doc(hidden)]
pub mod files;
#[doc(hidden)]
pub mod firmware;
#[doc(hidden)]
pub mod hierarchy;
#[doc(hidden)]
pub mod kernel;
#[doc(hidden)]
pub mod network;
#[doc(hidden)]
pub mod note;
#[doc(hidden)]
pub mod optics;
pub mod scenario;
#[doc(hidden)]
pub mod sensor;
#[doc(hidden)]
pub mod sim;
#[doc(hidden)]
pub mod waves;

pub use error::{Error, Input, Result};
pub use firmware::tof_top::slot::DepthM;
pub use kernel::time::Time;
pub use network::file::Network;
pub use network::histogram::Histogram;
pub use note::{Note, NoteCode, NoteValue};
pub use optics::budget::Budget;
pub use scenario::Scenario;
pub use scenario::window::Window;
pub use sim::callback::Callback;
pub use sim::cycles::Cycle;
pub use sim::estimates::Estimate;
pub use sim::fast::histogram::Histograms as HistogramRun;
pub use sim::frames::Frame;
pub use sim::run::{Observers, Outcome, Run};
pub use sim::second_opinion::SecondOpinion;
pub use sim::setup::Setup;
pub use sim::shot_recorder::Shot;
pub use sim::stepping::Stepping;
pub use sim::transactions::Transaction;
pub use waves::marks::Marks;
pub use waves::writer::{WaveFormat, Waves};
