//! What histograms are drawn for.

/// What the sensor looks at; all else is the scenario's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Distance of the target, what an estimator is to find (`target.distance_m`) [m].
    pub distance_m: f64,
    /// Reflectance of the target (`target.reflectance`) [1].
    pub reflectance: f64,
    /// Spectral irradiance of the target (`ambient.irradiance_w_m2_nm`) [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
}
