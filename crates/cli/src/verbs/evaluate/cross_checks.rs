//! Cross-checks of an evaluation: frames that are simulated cycle by cycle.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::dataset::{GridArray, Scene};
use tofsim_learn::evaluation::cross_check::CrossCheck;

use crate::verbs::scenes::Scenes;

use super::args::{Args, SHOWN};

impl Args {
    /// Compares both paths in the light and the setting in the middle of the grid, at some distances or pixels.
    pub(super) fn cross_check(
        &self,
        scenes: &Scenes,
        distances_m: &[f64],
        stop: Option<&AtomicBool>,
    ) -> Result<Vec<CrossCheck>> {
        if self.check == 0 {
            return Ok(Vec::new());
        }
        let (grid, setting) = (&scenes.grid, scenes.loaded.len() / 2);
        let scene = Scene {
            reflectance: grid.reflectances.middle(),
            irradiance_w_m2_nm: grid.irradiances_w_m2_nm.middle(),
            setting,
            ..Scene::default()
        };
        if let Some(array) = &grid.array {
            return self.cross_check_pixels(scenes, array, scene, stop);
        }
        let (loaded, source) = (&scenes.loaded[setting], &scenes.source);
        let check = |&distance_m| {
            let scene = Scene { distance_m, ..scene };
            CrossCheck::new(loaded, source, &scene, self.check, stop)
        };
        distances_m.iter().map(check).collect()
    }

    /// The same at some pixels of an array.
    fn cross_check_pixels(
        &self,
        scenes: &Scenes,
        pixels: &GridArray,
        scene: Scene,
        stop: Option<&AtomicBool>,
    ) -> Result<Vec<CrossCheck>> {
        let mut loaded = scenes.loaded[scene.setting].clone();
        loaded.scenario.target.reflectance = scene.reflectance;
        loaded.scenario.ambient.irradiance_w_m2_nm = scene.irradiance_w_m2_nm;
        let array = ArraySetup::of_counts(loaded)?;
        let places: Vec<_> = (0..pixels.count()).map(|pixel| pixel as f64).collect();
        let check = |place: f64| {
            let pixel = place as usize;
            let distance_m = pixels.depth_m(scene.setting, pixel, scene.reflectance);
            let scene = Scene { distance_m, pixel, ..scene };
            let [row, column] = pixels.place(pixel);
            let setup = array.pixel(row, column);
            let found = CrossCheck::of_setup(&setup, &scenes.source, &scene, self.check, stop)?;
            Ok(CrossCheck { pixel: Some([row, column]), ..found })
        };
        thinned(&places, SHOWN).into_iter().map(check).collect()
    }
}

/// Returns a line for each check.
pub(super) fn text(checks: &[CrossCheck]) -> String {
    let mut text = String::new();
    if !checks.is_empty() {
        text += "\n";
    }
    for check in checks {
        let place = match check.pixel {
            Some([row, column]) => format!("pixel {row},{column}"),
            None => format!("{} m", check.distance_m),
        };
        text += &format!(
            "{} frames cycle by cycle at {place}: counts as drawn, p = {:.3}; other depths: {}{}\n",
            check.frames,
            check.p_value,
            check.other_depths,
            if check.agrees() { "" } else { "  DIFFERENT" },
        );
    }
    text
}
