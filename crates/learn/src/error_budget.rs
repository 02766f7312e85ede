//! Which effect makes a depth wrong by how much: bias and spread with every effect off, with each alone, with all
//! but each, and with all together.
//!
//! A [variant] is a scenario with some effects off. Its histograms are drawn from the closed form, with
//! the same random numbers in each variant, so that the difference between two is known far better than either.
//! Without shot noise the histogram is the expected one, rounded to whole hits in sixteen ways. The estimator is
//! configured with the shots, bins and pulse of each variant, if it uses them. A network is not; effects that it was
//! not trained to work without are [left out](state::EffectState::LeftOut), that is, on throughout. An effect alone has no spread without shot noise: its bias is that of the expected histogram, its
//! spread that of the effect beside shot noise.
//!
//! Where shots depend on each other (afterpulses, MODE 1) there is no closed form. Such an effect is in the last
//! row only, for which frames are simulated shot by shot; it has what all together have more than the closed form
//! of the rest.

mod bound;
mod budget;
mod configured;
pub mod effect;
mod expected;
pub mod figures;
mod histograms;
mod plan;
mod presence;
mod quantile;
mod simulated;
pub mod state;
mod variant;

pub use bound::Bound;
pub use budget::{DepthBudget, EffectErrors};
pub use plan::Plan;
