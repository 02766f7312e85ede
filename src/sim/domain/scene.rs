//! Keys of a target that is no plain rectangle, of a second surface, the air and the cover window.

const PATCH: &str = "target.retro_side_m";
const VISIBILITY: &str = "atmosphere.visibility_m";
const RAIN: &str = "atmosphere.rain_mm_h";
pub const SHAPE: &str = "target.shape";
/// Keys that decide something with one shape.
const OF_SHAPE: [(&str, &[&str]); 4] = [
    ("disc", &["target.radius_m"]),
    ("sphere", &["target.radius_m"]),
    ("step", &["target.second_distance_m", "target.edge_m"]),
    ("mesh", &["target.mesh_unit_m", "target.mesh_file"]),
];
/// Keys that decide something where another one is not 0.
const OF_NUMBER: [(&str, &[&str]); 6] = [
    ("target.second_share", &["target.second_distance_m", "target.second_reflectance"]),
    ("cover.fraction", &COVER),
    ("cover.dirt_per_h", &COVER),
    (PATCH, &["target.retro_x_m", "target.retro_y_m", "target.retro_cd_lx_m2"]),
    (
        VISIBILITY,
        &[
            "atmosphere.visibility_model",
            "atmosphere.visibility_contrast",
            LIDAR_RATIO,
            OVERLAP,
            AIRLIGHT,
        ],
    ),
    (RAIN, &["atmosphere.rain_db_km", "atmosphere.rain_exponent", LIDAR_RATIO, OVERLAP, AIRLIGHT]),
];
const COVER: [&str; 6] = [
    "cover.delay_ps",
    "cover.width_ps",
    "cover.smear_fraction",
    "cover.smear_ps",
    "cover.temperature_coefficient_per_k",
    "cover.age_h",
];
const LIDAR_RATIO: &str = "atmosphere.lidar_ratio_sr";
const OVERLAP: &str = "atmosphere.overlap_m";
const AIRLIGHT: &str = "atmosphere.airlight";

/// Keys that decide something with such a shape, and where those are not 0 that `is_there` says so of.
pub fn keys(shape: &str, is_there: impl Fn(&str) -> bool) -> Vec<&'static str> {
    let shapes = OF_SHAPE.into_iter().filter(|(name, _)| *name == shape);
    let numbers = OF_NUMBER.into_iter().filter(|(key, _)| is_there(key));
    shapes.chain(numbers).flat_map(|(_, keys)| keys).copied().collect()
}
