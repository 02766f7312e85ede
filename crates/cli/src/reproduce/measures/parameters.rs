//! Parameters of peak detection, of the grids and of the training.

use tofsim::error::Result;
use tofsim_learn::dataset::{Axis, Grid};
use tofsim_learn::estimation::findpeaks::{self, Criteria};
use tofsim_learn::training::features::InputScale;
use tofsim_learn::training::recipe::Recipe;

use crate::reproduce::measured::Measured;
use crate::reproduce::scenes::detection;
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

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
