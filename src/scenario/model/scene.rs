//! Keys of the target and of the air.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shape of a target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Flat rectangle of `length_m` by `width_m`.
    #[default]
    Rectangle,
    /// Flat disc of `radius_m`.
    Disc,
    /// Sphere of `radius_m`, whose nearest point is at `distance_m`.
    Sphere,
    /// Rectangle whose part beyond `edge_m` is at `second_distance_m`.
    Step,
    /// Triangles from `mesh_file`.
    Mesh,
}

table! {
    /// The target: by default a rectangle perpendicular to the optical axis and centred on it.
    pub struct Target {
        /// Distance from the sensor. Light that comes after the next pulse is not simulated.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2: 0.1 .. 0.6"))]
        pub distance_m: f64 = 0.5,
        /// Fraction of light that is reflected diffusely.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2: 0.08 .. 0.60"))]
        pub reflectance: f64 = 0.34,
        /// Length of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub length_m: f64 = 0.26,
        /// Width of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub width_m: f64 = 0.20,
        /// Number of surface elements along each side of the illuminated part of a quadrant (eq. 3.6); for a mesh,
        /// one eighth of those along the side of its visible part, up to 4096.
        #[schemars(range(min = 8, max = 1024), extend("unit" = "1", "source" = "choice: below 0.05 % of error"))]
        pub cells: u32 = 128,
        /// Shape: `rectangle`, `disc`, `sphere`, `step` or `mesh`.
        #[schemars(extend("source" = "Table 3.2: a rectangle"))]
        pub shape: Shape = Shape::Rectangle,
        /// Use a separate time of flight for each element of a plain rectangle, as for all other targets; false: all
        /// light has the time of flight along the axis.
        #[schemars(extend("source" = "eq. 3.23: false"))]
        pub extended: bool = false,
        /// Rotation about the horizontal axis (along the length), which moves the upper edge away from the sensor.
        #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "deg", "source" = "section 3.1: perpendicular"))]
        pub tilt_deg: f64 = 0.0,
        /// Rotation about the vertical axis (along the width), before the tilt, which moves the right edge away.
        #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "deg", "source" = "section 3.1: perpendicular"))]
        pub yaw_deg: f64 = 0.0,
        /// Offset to the right of the axis, along the length.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "section 3.1: centred"))]
        pub offset_x_m: f64 = 0.0,
        /// Offset above the axis, along the width.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "section 3.1: centred"))]
        pub offset_y_m: f64 = 0.0,
        /// Radius of a disc or a sphere.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "choice: the width of the rectangle across"))]
        pub radius_m: f64 = 0.1,
        /// Distance of the second part of a step, or of the second surface of `target.second_share`.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "choice: 20 cm behind the first"))]
        pub second_distance_m: f64 = 0.7,
        /// Position of a step's edge, to the right of the target's centre; 0: the parts have equal size.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: half and half"))]
        pub edge_m: f64 = 0.0,
        /// Share of the lines of sight that end on a second surface, and not on the target: a net, an edge or a
        /// transparent plate in front of the target, or what is seen through it. The surface is a rectangle of
        /// `length_m` by `width_m`, perpendicular to the axis and centred on it, at `second_distance_m`; 0: none.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub second_share: f64 = 0.0,
        /// Fraction of light that the second surface reflects diffusely.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: that of the first"))]
        pub second_reflectance: f64 = 0.34,
        /// Side of a square retroreflective patch on a rectangle or a disc; 0: none.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "m", "source" = "choice: none"))]
        pub retro_side_m: f64 = 0.0,
        /// Offset of the patch's centre to the right of the target's centre.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: in the middle"))]
        pub retro_x_m: f64 = 0.0,
        /// Offset of the patch's centre above the target's centre.
        #[schemars(range(min = -1000.0, max = 1000.0), extend("unit" = "m", "source" = "choice: in the middle"))]
        pub retro_y_m: f64 = 0.0,
        /// Coefficient of retroreflection of the patch; that of white paper is 1/pi. It does not depend on
        /// `reflectance`.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "cd/lx/m^2", "source" = "ASTM D4956: white sheeting of type I, at 0.2 and -4 deg"))]
        pub retro_cd_lx_m2: f64 = 70.0,
        /// Triangle mesh: an OBJ or STL file with x to the right, y up and z towards the sensor. Its origin is on the
        /// axis, and its nearest point at `distance_m`.
        #[schemars(extend("source" = "choice: none"))]
        pub mesh_file: Option<String> = None,
        /// Length of the mesh file's unit.
        #[schemars(range(min = 1e-6, max = 1e6), extend("unit" = "m", "source" = "choice: metres"))]
        pub mesh_unit_m: f64 = 1.0,
    }
}

/// Wavelength dependence of extinction by fog and haze.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VisibilityModel {
    /// Kim's exponent: no wavelength dependence in fog with a visibility below 500 m.
    #[default]
    Kim,
    /// Kruse's exponent, for haze.
    Kruse,
    /// No wavelength dependence: extinction as at 550 nm.
    Flat,
}

table! {
    /// The air between sensor and target, which is homogeneous. By default it has no effect.
    pub struct Atmosphere {
        /// Visibility in fog or haze; 0: no fog.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "m", "source" = "choice: none, as in the thesis"))]
        pub visibility_m: f64 = 0.0,
        /// Wavelength dependence of the extinction: `kim`, `kruse` or `flat`.
        #[schemars(extend("source" = "Kim, McArthur, Korevaar, Proc. SPIE 4214 (2001)"))]
        pub visibility_model: VisibilityModel = VisibilityModel::Kim,
        /// Contrast at the visibility distance, at 550 nm, by which visibility is defined; 0.05 in WMO's definition.
        #[schemars(range(min = 0.001, max = 0.5), extend("unit" = "1", "source" = "Koschmieder 1924: 0.02, so that extinction is 3.912 / V"))]
        pub visibility_contrast: f64 = 0.02,
        /// Rain rate; 0: no rain.
        #[schemars(range(min = 0.0, max = 500.0), extend("unit" = "mm/h", "source" = "choice: none, as in the thesis"))]
        pub rain_mm_h: f64 = 0.0,
        /// Extinction by rain of 1 mm/h.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "dB/km", "source" = "Carbonneau, Wisely, Proc. SPIE 3532 (1998)"))]
        pub rain_db_km: f64 = 1.076,
        /// Exponent of the extinction as a function of the rain rate.
        #[schemars(range(min = 0.0, max = 2.0), extend("unit" = "1", "source" = "Carbonneau, Wisely, Proc. SPIE 3532 (1998)"))]
        pub rain_exponent: f64 = 0.67,
        /// Ratio of extinction to backscatter, for fog and rain.
        #[schemars(range(min = 1.0, max = 1e6), extend("unit" = "sr", "source" = "O'Connor, Illingworth, Hogan 2004: droplets at 905 nm, 18.8 +- 0.8; for rain a choice"))]
        pub lidar_ratio_sr: f64 = 18.8,
        /// Distance at which the sensor's field of view begins to overlap the beam; nearer air returns no light.
        #[schemars(range(min = 0.001, max = 1000.0), extend("unit" = "m", "source" = "choice: the nearest distance of Table 3.2"))]
        pub overlap_m: f64 = 0.1,
        /// Ambient light scattered to the sensor by an infinite depth of air, relative to a white target; 0: none.
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "1", "source" = "choice: the horizon in fog is as bright as white paper"))]
        pub airlight: f64 = 1.0,
    }
}

impl Target {
    /// Returns the second surface as a target by itself; `None` if no line of sight ends on it.
    pub fn second(&self) -> Option<Target> {
        let &Target { length_m, width_m, cells, .. } = self;
        (self.second_share > 0.0).then(|| Target {
            distance_m: self.second_distance_m,
            reflectance: self.second_reflectance,
            length_m,
            width_m,
            cells,
            ..Target::default()
        })
    }

    /// Returns whether the target is flat: a rectangle, a disc or a step.
    pub fn is_flat(&self) -> bool {
        matches!(self.shape, Shape::Rectangle | Shape::Disc | Shape::Step)
    }
}
