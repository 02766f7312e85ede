//! Parameters of laser and optics, of peak detection, of the grids and of the training.

use tofsim::error::Result;
use tofsim::optics::eye_safety::accessible_emission_limit_j;
use tofsim_learn::dataset::{Axis, Grid};
use tofsim_learn::estimation::findpeaks::{self, Criteria};
use tofsim_learn::training::features::InputScale;
use tofsim_learn::training::recipe::Recipe;

use crate::reproduce::scenes::detection;
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

pub(super) fn findpeaks(_: &Study) -> Result<Measured> {
    let detection = detection();
    // 8 high on 2: at half of its height above zero, which is 5, it is 12.5 wide, and 10 at half of its prominence.
    let x: Vec<f64> = (0..=40).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| 2.0 + (8.0 - 0.8 * (x - 20.0).abs()).max(0.0)).collect();
    let peaks = findpeaks::findpeaks(&x, &y, &Criteria { min_prominence: 1.0, max_width: 40.0 });
    let mut values = Values::default();
    values.put("prominence", detection.prominence);
    values.put("max_width_ps", detection.max_width_ps);
    values.put("width", peaks.first().map_or(f64::NAN, |peak| peak.width));
    Ok(values.into())
}

pub(super) fn grids(_: &Study) -> Result<Measured> {
    let (training, test) = (Grid::training(), Grid::test());
    let range = |axis: &Axis| {
        let [from, until] = axis.range();
        let step = (until - from) / (axis.count() - 1) as f64;
        format!("{from} to {until}, step {}", (1e6 * step).round() / 1e6)
    };
    let is_between = |m| !training.distances_m.values.contains(m);
    let mut values = Values::default();
    values.put_words("irradiances", range(&training.irradiances_w_m2_nm));
    values.put_words("reflectances", range(&training.reflectances));
    values.put_words("training_distances", range(&training.distances_m));
    values.put_words("test_distances", range(&test.distances_m));
    values.put("repeats", training.repeats as f64);
    values.put("training_rows", training.rows() as f64);
    values.put("test_rows", test.rows() as f64);
    let are_between = test.distances_m.values.iter().any(is_between);
    values.put("test_distances_between", f64::from(are_between));
    Ok(values.into())
}

pub(super) fn training(_: &Study) -> Result<Measured> {
    let name = "trainlm";
    let text = Recipe::builtin_text(name).unwrap_or_default();
    let recipe = Recipe::parse(text, &Recipe::default(), &[], name)?;
    let mut values = Values::of(&recipe);
    let scale = match recipe.inputs {
        InputScale::Range => "mapminmax",
        InputScale::Deviation => "standard deviations",
    };
    values.put_words("input_scale", scale);
    values.put("starts", recipe.stages[0].candidates as f64);
    values.put("epochs", recipe.stages.iter().map(|stage| stage.epochs as f64).sum());
    Ok(values.into())
}

/// Wavelength of the laser [nm].
const LASER_NM: f64 = 940.0;

pub(super) fn emission_limits(_: &Study) -> Result<Measured> {
    let limit = |exposure_s, nm| accessible_emission_limit_j(exposure_s, nm).unwrap_or(f64::NAN);
    let mut values = Values::default();
    // C4 is 1 at 700 nm.
    values.put("c4", limit(1.0, LASER_NM) / limit(1.0, 700.0));
    for (name, exposure_s) in [("of_1_ps", 1e-12), ("of_1_ns", 1e-9), ("of_1_s", 1.0)] {
        values.put(name, limit(exposure_s, LASER_NM));
    }
    Ok(values.into())
}

pub(super) fn eye_safety(study: &Study) -> Result<Measured> {
    let exposure = study.ideal()?.exposure_at_the_optics_rate();
    let mut values = Values::default();
    values.put("limit_w", exposure.limit_w.unwrap_or(f64::NAN));
    values.put("average_w", exposure.average_w);
    values.put("exposure_s", exposure.exposure_s);
    Ok(values.into())
}

pub(super) fn specifications(study: &Study) -> Result<Measured> {
    let mut values = Values::of(&study.ideal()?.scenario);
    let lit = study.setup("kc705", &["ambient.illuminance_klux=14"])?.scenario;
    values.put("passband_of_14_klux", lit.ambient.irradiance_w_m2_nm);
    Ok(values.into())
}
