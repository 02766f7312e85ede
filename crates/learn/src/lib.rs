//! From histograms to metres, beyond the firmware's own estimator.
//!
//! Estimators ([`estimation`]), histograms in bulk ([`dataset`]), training of the network
//! ([`training`]), its numbers in other formats ([`quantize`]), and how exactly all of them find the
//! distance ([`evaluation`]).

pub mod dataset;
pub mod estimation;
pub mod evaluation;
pub mod quantize;
pub mod training;
