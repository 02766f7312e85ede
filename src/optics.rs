//! From the scene to photons: link budget, eye safety and the statistics of the first avalanche.

mod air;
pub mod budget;
pub mod camera;
pub mod cause_parts;
pub mod chances;
pub mod closed_form;
mod cover;
pub mod dark;
pub mod eye_safety;
pub mod first_photon;
mod geometry;
pub mod hazard;
mod photometry;
pub mod pixel_budgets;
pub mod pixels;
mod returned;
mod scene;
mod spread;
pub mod variation;

pub use budget::Budget;
pub use camera::Camera;
pub use chances::Chances;
pub use closed_form::{BinProbabilities, Bins};
pub use hazard::{Cause, Hazard};
pub use pixel_budgets::PixelBudgets;
pub use pixels::Pixels;
