//! The pixels of an array as a pinhole camera with radial distortion.

use serde::Serialize;

use super::pixels::Pixels;

/// Camera matrix and distortion in OpenCV's convention: the middles of pixels have whole coordinates, and the axes point
/// to the right, down and forward.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Camera {
    /// Full angles of the field of view across the middle row and the middle column [deg].
    pub field_of_view_deg: [f64; 2],
    /// Directions of the axes.
    pub axes: &'static str,
    /// Focal length in the width of a pixel [pixels].
    pub fx: f64,
    /// Focal length in the height of a pixel [pixels].
    pub fy: f64,
    /// Column of the optical axis [pixels].
    pub cx: f64,
    /// Row of the optical axis [pixels].
    pub cy: f64,
    /// Radial distortion k1 and k2, then the tangential one, which is none [1].
    pub distortion: [f64; 4],
}

impl Camera {
    /// Returns the camera of an array with a radial distortion k1 and k2.
    pub fn of(pixels: &Pixels, [k1, k2]: [f64; 2]) -> Self {
        let [fx, fy] = pixels.focal_pixels();
        let middle = |count: usize| (count as f64 - 1.0) / 2.0;
        Camera {
            field_of_view_deg: pixels.field_of_view_deg(),
            axes: "x to the right, y down, z forward",
            fx,
            fy,
            cx: middle(pixels.columns),
            cy: middle(pixels.rows),
            distortion: [k1, k2, 0.0, 0.0],
        }
    }
}
