//! Result of an error budget.

use crate::estimation::EstimatorKind;

use super::bound::Bound;
use super::effect::Effect;
use super::figures::{ErrorChange, ErrorFigures};
use super::presence::EffectState;

/// The budget of one scene.
#[derive(Clone, Debug)]
pub struct DepthBudget {
    /// Estimator that makes the errors.
    pub kind: EstimatorKind,
    /// Frames drawn of each variant.
    pub frames: u64,
    /// True distance [m].
    pub distance_m: f64,
    /// With every effect off: the estimator's own error.
    pub none: ErrorFigures,
    /// Each effect, in their order.
    pub effects: Vec<EffectErrors>,
    /// With all effects together.
    pub together: ErrorFigures,
    /// Sum of what each effect alone adds to the bias, and to that of the estimator itself [mm].
    pub sum_mean_mm: f64,
    /// Twice the root of the sum of what each effect adds to the variance [mm].
    pub sum_two_sd_mm: f64,
    /// The Cramer-Rao bound, as twice a standard deviation.
    pub bound: Bound,
}

/// Errors due to one effect.
#[derive(Clone, Debug)]
pub struct EffectErrors {
    /// Effect that the row is for.
    pub effect: Effect,
    /// Whether the effect is measured.
    pub state: EffectState,
    /// With it alone; the spread is that beside shot noise.
    pub alone: Option<ErrorFigures>,
    /// With all but it.
    pub all_but: Option<ErrorFigures>,
    /// Errors with the effect alone, less those without any effect; in the variance, less those of shot noise. Uneven
    /// taps and a wrong ROM are relative to the width of taps.
    pub adds: Option<ErrorChange>,
    /// Errors with all effects, less those with all but this one.
    pub takes: Option<ErrorChange>,
}
