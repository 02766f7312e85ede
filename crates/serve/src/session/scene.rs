//! Scene keys that have sliders on the page.

use std::collections::BTreeMap;

use serde::Serialize;

use tofsim::error::{Input, Result};
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::scenario::Scenario;
use tofsim::sim::setup::Setup;

/// A scene key with its label, its unit, and the range and step of its slider.
struct Key {
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    range: [f64; 3],
    /// Whether zero means more than the largest value, such as the visibility of clear air.
    zero_is_far: bool,
    of: fn(&Scenario) -> f64,
}

const KEYS: [Key; 7] = [
    Key {
        key: DISTANCE,
        label: "Distance",
        unit: "m",
        range: [0.05, 0.95, 0.005],
        zero_is_far: false,
        of: |scenario| scenario.target.distance_m,
    },
    Key {
        key: "target.reflectance",
        label: "Reflectance",
        unit: "",
        range: [0.0, 1.0, 0.01],
        zero_is_far: false,
        of: |scenario| scenario.target.reflectance,
    },
    Key {
        key: "ambient.irradiance_w_m2_nm",
        label: "Ambient light",
        unit: "W/m²/nm",
        range: [0.0, 1.0, 0.01],
        zero_is_far: false,
        of: |scenario| scenario.ambient.irradiance_w_m2_nm,
    },
    Key {
        key: "atmosphere.visibility_m",
        label: "Fog: visibility",
        unit: "m",
        range: [0.5, 5000.0, 0.0],
        zero_is_far: true,
        of: |scenario| scenario.atmosphere.visibility_m,
    },
    Key {
        key: "atmosphere.rain_mm_h",
        label: "Rain",
        unit: "mm/h",
        range: [0.0, 150.0, 1.0],
        zero_is_far: false,
        of: |scenario| scenario.atmosphere.rain_mm_h,
    },
    Key {
        key: "cover.fraction",
        label: "Cover glass",
        unit: "",
        range: [0.0, 1e-3, 1e-5],
        zero_is_far: false,
        of: |scenario| scenario.cover.fraction,
    },
    Key {
        key: "target.second_share",
        label: "Second surface",
        unit: "",
        range: [0.0, 1.0, 0.01],
        zero_is_far: false,
        of: |scenario| scenario.target.second_share,
    },
];

const DISTANCE: &str = "target.distance_m";

/// A slider with its present value.
#[derive(Clone, Debug, Serialize)]
pub struct Slider {
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    value: f64,
    least: f64,
    most: f64,
    /// Step; 0 for a logarithmic scale.
    step: f64,
    zero_is_far: bool,
}

/// Returns the sliders of a scene, for the histogram of a setup.
pub fn sliders(setup: &Setup, scene: &Scenario) -> Vec<Slider> {
    let window_m =
        setup.bins().spans().last().map_or(1.0, |span| span.until.seconds()) * LIGHT_M_S / 2.0;
    let slider = |key: &Key| {
        let [least, most, step] = key.range;
        let most = if key.key == DISTANCE { (window_m * 20.0).floor() / 20.0 } else { most };
        let (key, label, unit, zero_is_far) = (key.key, key.label, key.unit, key.zero_is_far);
        let value = (of(key))(scene);
        Slider { key, label, unit, value, least, most, step, zero_is_far }
    };
    KEYS.iter().map(slider).collect()
}

/// Returns whether the scenes of two setups differ.
pub fn differ(one: &Setup, other: &Setup) -> bool {
    KEYS.iter().any(|key| (key.of)(&one.scenario) != (key.of)(&other.scenario))
}

fn of(key: &str) -> fn(&Scenario) -> f64 {
    KEYS.iter().find(|known| known.key == key).map_or(|_| 0.0, |known| known.of)
}

/// Adds the changes of a request to those requested before.
///
/// # Errors
/// If there is no key, or a key is not one of the scene.
pub fn lay_over(scene: &mut BTreeMap<String, f64>, asked: BTreeMap<String, f64>) -> Result<()> {
    let names = || KEYS.map(|key| key.key).join(", ");
    if asked.is_empty() {
        return Err(Input::new("scene", format!("expected one of {}", names())).into());
    }
    for (key, value) in asked {
        if !KEYS.iter().any(|known| known.key == key) {
            let expected = format!("no such key of the scene; expected one of {}", names());
            return Err(Input::new("scene", expected).field(key).value(value).into());
        }
        scene.insert(key, value);
    }
    Ok(())
}

/// Formats the changes of the scene as overrides.
pub fn overrides(scene: &BTreeMap<String, f64>) -> Vec<String> {
    scene.iter().map(|(key, value)| format!("{key}={value:?}")).collect()
}
