//! What is measured, and the air before it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a target looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Flat, with the sides `length_m` and `width_m`.
    #[default]
    Rectangle,
    /// Flat and round, with `radius_m`.
    Disc,
    /// A ball of `radius_m`, whose nearest point is at `distance_m`.
    Sphere,
    /// A rectangle of which the part beyond `edge_m` stands at `second_distance_m`.
    Step,
    /// Triangles from `mesh_file`.
    Mesh,
}

table! {
    /// What is measured: a rectangle, perpendicular to the axis, centred on it, unless keys say otherwise.
    pub struct Target {
        /// Distance from the sensor. Light that comes after the next pulse is not simulated.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2: 0.1 .. 0.6"))]
        pub distance_m: f64 = 0.5,
        /// Fraction of light that is diffused back.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2: 0.08 .. 0.60"))]
        pub reflectance: f64 = 0.34,
        /// Length of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub length_m: f64 = 0.26,
        /// Width of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub width_m: f64 = 0.20,
        /// Sub-elements of the lit part of a quadrant, along each side (eq. 3.6); of a mesh an eighth of those along
        /// the side of what is seen of it, up to 4096.
        #[schemars(range(min = 8, max = 4096), extend("unit" = "1", "source" = "choice: below 0.05 % of error"))]
        pub cells: u32 = 128,
        /// What it looks like: `rectangle`, `disc`, `sphere`, `step` or `mesh`.
        #[schemars(extend("source" = "Table 3.2: a rectangle"))]
        pub shape: Shape = Shape::Rectangle,
        /// Whether the light of each element of a plain rectangle comes after its own way, as that of any other
        /// target does; false: all of it after the way along the axis.
        #[schemars(extend("source" = "eq. 3.23: false"))]
        pub extended: bool = false,
        /// Turn about the horizontal axis (along the length), which takes the upper edge away from the sensor.
        #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "deg", "source" = "section 3.1: perpendicular"))]
        pub tilt_deg: f64 = 0.0,
        /// Turn about the vertical axis (along the width), before the tilt, which takes the right edge away.
        #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "deg", "source" = "section 3.1: perpendicular"))]
        pub yaw_deg: f64 = 0.0,
        /// How far it stands to the right of the axis, along the length.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "section 3.1: centred"))]
        pub offset_x_m: f64 = 0.0,
        /// How far it stands above the axis, along the width.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "section 3.1: centred"))]
        pub offset_y_m: f64 = 0.0,
        /// Radius of a disc or a sphere.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "choice: the width of the rectangle across"))]
        pub radius_m: f64 = 0.1,
        /// Distance at which the second part of a step stands.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "choice: 20 cm behind the first"))]
        pub second_distance_m: f64 = 0.7,
        /// Where the first part of a step ends, to the right of its centre: 0 gives each half of the rectangle.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: half and half"))]
        pub edge_m: f64 = 0.0,
        /// Side of a square patch that sends light back to where it comes from, on a rectangle or a disc; 0: none.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "m", "source" = "choice: none"))]
        pub retro_side_m: f64 = 0.0,
        /// How far the centre of the patch lies to the right of the target's.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: in the middle"))]
        pub retro_x_m: f64 = 0.0,
        /// How far it lies above.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: in the middle"))]
        pub retro_y_m: f64 = 0.0,
        /// Coefficient of retroreflection of the patch; that of white paper is 1/pi. It does not go with `reflectance`.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "cd/lx/m^2", "source" = "ASTM D4956: white sheeting of type I, at 0.2 and -4 deg"))]
        pub retro_cd_lx_m2: f64 = 70.0,
        /// The triangles of a mesh: an OBJ or STL file. It has x to the right, y up and z towards the sensor, with its
        /// origin on the axis; its nearest point is at `distance_m`.
        #[schemars(extend("source" = "choice: none"))]
        pub mesh_file: Option<String> = None,
        /// Length of a unit of the file.
        #[schemars(range(min = 1e-6, max = 1e6), extend("unit" = "m", "source" = "choice: metres"))]
        pub mesh_unit_m: f64 = 1.0,
    }
}

/// How extinction by fog goes with the wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VisibilityModel {
    /// Kim's exponent: fog of less than 500 m knows no wavelength.
    #[default]
    Kim,
    /// Kruse's exponent, for haze.
    Kruse,
    /// As at 550 nm.
    Flat,
}

table! {
    /// The air between sensor and target, the same everywhere. None of it by default.
    pub struct Atmosphere {
        /// Visibility in fog or haze; 0: none.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "m", "source" = "choice: none, as in the thesis"))]
        pub visibility_m: f64 = 0.0,
        /// How its extinction goes with the wavelength: `kim`, `kruse` or `flat`.
        #[schemars(extend("source" = "Kim, McArthur, Korevaar, Proc. SPIE 4214 (2001)"))]
        pub visibility_model: VisibilityModel = VisibilityModel::Kim,
        /// Contrast that is left at that distance, at 550 nm. WMO states visibility for 0.05.
        #[schemars(range(min = 0.001, max = 0.5), extend("unit" = "1", "source" = "Koschmieder 1924: 0.02, so that extinction is 3.912 / V"))]
        pub visibility_contrast: f64 = 0.02,
        /// Rate of rain; 0: none.
        #[schemars(range(min = 0.0, max = 500.0), extend("unit" = "mm/h", "source" = "choice: none, as in the thesis"))]
        pub rain_mm_h: f64 = 0.0,
        /// Extinction by rain of 1 mm/h.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "dB/km", "source" = "Carbonneau, Wisely, Proc. SPIE 3532 (1998)"))]
        pub rain_db_km: f64 = 1.076,
        /// Exponent by which it goes with the rate.
        #[schemars(range(min = 0.0, max = 2.0), extend("unit" = "1", "source" = "Carbonneau, Wisely, Proc. SPIE 3532 (1998)"))]
        pub rain_exponent: f64 = 0.67,
        /// Extinction to backscatter, of fog and rain.
        #[schemars(range(min = 1.0, max = 1e6), extend("unit" = "sr", "source" = "O'Connor, Illingworth, Hogan 2004: droplets at 905 nm, 18.8 +- 0.8; for rain a choice"))]
        pub lidar_ratio_sr: f64 = 18.8,
        /// Nearer air sends nothing back to the sensor: its field of view begins to overlap the beam there.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "choice: the nearest distance of Table 3.2"))]
        pub overlap_m: f64 = 0.1,
        /// Ambient light that endless air scatters to the sensor, to that of a white target; 0: none.
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "1", "source" = "choice: the horizon in fog is as bright as white paper"))]
        pub airlight: f64 = 1.0,
    }
}

impl Target {
    /// Whether it is flat: a rectangle, a disc or a step.
    pub fn is_flat(&self) -> bool {
        matches!(self.shape, Shape::Rectangle | Shape::Disc | Shape::Step)
    }
}
