//! From histograms to metres, beyond the firmware's own estimator.
//!
//! Estimators ([`estimation`]), what they have to know of an instrument ([`calibration`]), what its TDC is like
//! ([`characterisation`]) and does as its die heats up ([`drift`]), histograms in bulk ([`dataset`]), training of the network
//! ([`training`]), its numbers in other formats ([`quantize`]), how exactly all of them find the
//! distance ([`evaluation`]), and which effect makes them wrong by how much ([`error_budget`]).

pub mod calibration;
pub mod characterisation;
pub mod dataset;
pub mod drift;
pub mod error_budget;
pub mod estimation;
pub mod evaluation;
pub mod quantize;
pub mod training;
