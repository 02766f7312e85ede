//! Estimators, held to what others compute.

mod calibration;
mod characterisation;
mod estimators;
mod glass;
mod recalibration;
mod sunlight;
