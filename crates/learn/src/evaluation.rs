//! Accuracy of estimators: errors over a grid of scenes, with new histograms drawn for each.
//!
//! Every estimator sees the same histograms; one that needs dark histograms too sees pairs of its own. Errors are
//! kept row by row, so that any grouping of them is exact: by distance, as in the thesis, by reflectance, by
//! irradiance, by scene.

pub mod bound;
pub mod by_pixel;
pub mod by_scene;
pub mod by_setting;
pub mod cross_check;
pub mod errors;
pub mod exploration;
pub mod figures;
pub mod images;
pub mod spread;
pub mod tails;
pub mod thesis;

pub use by_pixel::{PixelSpread, SceneImages};
pub use by_scene::{SceneErrors, by_scene, most_biased};
pub use by_setting::{KeyGroups, by_setting};
pub use errors::{EstimatorErrors, Evaluation};
pub use figures::Figures;
pub use spread::{Group, Spread};
pub use tails::Tails;
