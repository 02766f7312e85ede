//! Columns with the scenes of a grid, as a dataset's files have them.

use super::grid::{DISTANCE, Grid, IRRADIANCE, REFLECTANCE, Scene};

/// Columns of the scenes, the first one necessary.
pub(super) const TRUTH: [&str; 3] = ["distance_m", "reflectance", "irradiance_w_m2_nm"];
/// Columns with the place of an array's pixel, from 0 at the top left.
pub const PIXEL: [&str; 2] = ["pixel_row", "pixel_column"];

/// A column with a number of each scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneColumn<'a> {
    /// Its name.
    pub name: &'a str,
    /// Key of the scenario whose values it has; `None` of what only a pixel of an array has.
    pub key: Option<&'a str>,
    /// Whether the numbers are whole ones from 0.
    pub is_index: bool,
}

impl Grid {
    /// Returns the columns of the scenes, in their order: distance and light, pixel, other keys.
    pub fn columns(&self) -> Vec<SceneColumn<'_>> {
        let is_array = self.array.is_some();
        let keys = [(!is_array).then_some(DISTANCE), Some(REFLECTANCE), Some(IRRADIANCE)];
        let scene = TRUTH.into_iter().zip(keys);
        let scene = scene.map(|(name, key)| SceneColumn { name, key, is_index: false });
        let pixel = PIXEL.into_iter().filter(|_| is_array);
        let pixel = pixel.map(|name| SceneColumn { name, key: None, is_index: true });
        let others = self.others.iter().map(|axis| &*axis.key);
        let others = others.map(|name| SceneColumn { name, key: Some(name), is_index: false });
        scene.chain(pixel).chain(others).collect()
    }

    /// Returns the numbers of a scene for those columns.
    pub fn values(&self, scene: &Scene) -> Vec<f64> {
        let truth = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
        let place = self.array.iter().flat_map(|array| array.place(scene.pixel));
        let others = self.setting(scene.setting).into_iter().map(|(_, value)| value);
        truth.into_iter().chain(place.map(|index| index as f64)).chain(others).collect()
    }
}
