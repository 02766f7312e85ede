//! The estimators' numbers in other formats: networks from elsewhere, other datapaths, and what each
//! rounding costs.

pub mod circuit;
pub mod cost;
pub mod explain;
pub mod import;
pub mod likelihood;

pub use circuit::Circuit;
pub use cost::Cost;
pub use explain::{Explanation, explain};
pub use likelihood::{ExplainedLikelihood, LikelihoodExplainer};
