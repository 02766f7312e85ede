//! Checks of the cover window's keys that involve more than one key.

use std::fmt::Display;

use crate::error::Result;
use crate::files::toml::Checked;
use crate::scenario::model::{Cover, Scenario, Shape};

/// Speed of light, exact in the SI [m/ps].
const LIGHT_M_PS: f64 = 299_792_458.0e-12;

/// Checks that the window is in front of the target, and sends back no less than nothing and no more than the pulse.
///
/// # Errors
/// The first key that violates a constraint.
pub fn check(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let Scenario { cover, array, spad, .. } = scenario;
    let fault = |key: &str, value: &dyn Display, expected: String| {
        Err(checked.fault(key, expected).value(value).into())
    };
    if let Some(file) = &cover.fraction_file {
        if array.count() == 1 {
            let expected = "expected none, or several pixels (array.rows, array.columns)";
            return fault("cover.fraction_file", file, expected.to_owned());
        }
        if cover.fraction > 0.0 {
            let expected = "expected 0: cover.fraction_file says what the fractions are";
            return fault("cover.fraction", &cover.fraction, expected.to_owned());
        }
    }
    if !cover.is_there() {
        return Ok(());
    }
    let nearest_m = nearest_m(scenario);
    let echo_ps = 2.0 * nearest_m / LIGHT_M_PS;
    if cover.delay_ps > echo_ps {
        let expected = format!(
            "expected {echo_ps:.1} [ps] at most, the time of flight to the target at {nearest_m} m: the window is in \
             front of it"
        );
        return fault("cover.delay_ps", &cover.delay_ps, expected);
    }
    let Cover { temperature_coefficient_per_k: coefficient, .. } = *cover;
    let factor = cover.temperature_factor(spad.temperature_c);
    if factor < 0.0 {
        let expected = format!(
            "expected a fraction of 0 at least: it would be {factor:.3} times that at 20 deg C (spad.temperature_c = {})",
            spad.temperature_c
        );
        return fault("cover.temperature_coefficient_per_k", &coefficient, expected);
    }
    let whole = cover.fraction * factor + cover.dirt();
    if whole > 1.0 {
        let key = if cover.dirt() > 0.0 { "cover.dirt_per_h" } else { "cover.fraction" };
        let value = if cover.dirt() > 0.0 { cover.dirt_per_h } else { cover.fraction };
        let expected = format!(
            "expected no more than the pulse: with temperature (spad.temperature_c) and dirt (cover.age_h) it would be \
             {whole:.3} of it"
        );
        return fault(key, &value, expected);
    }
    Ok(())
}

/// Returns the distance of the nearest surface [m].
fn nearest_m(scenario: &Scenario) -> f64 {
    let target = &scenario.target;
    let has_second = target.shape == Shape::Step || target.second_share > 0.0;
    let second_m = if has_second { target.second_distance_m } else { f64::INFINITY };
    target.distance_m.min(second_m)
}

#[cfg(test)]
mod tests {
    use crate::scenario::load;

    fn error(overrides: &[&str]) -> String {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        load("kc705", &overrides).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_window_behind_the_target_is_refused() {
        let found = error(&["cover.fraction=1e-4", "cover.delay_ps=3400"]);
        assert!(found.contains("cover.delay_ps = 3400: expected 3335.6 [ps] at most"), "{found}");
        assert_eq!(error(&["cover.fraction=1e-4", "cover.delay_ps=3300"]), "");
        assert_eq!(error(&["cover.delay_ps=3400"]), "", "there is no window");
        let near = ["target.second_share=0.2", "target.second_distance_m=0.3"];
        let found = error(&[&["cover.fraction=1e-4", "cover.delay_ps=2100"], &near[..]].concat());
        assert!(found.contains("cover.delay_ps = 2100: expected 2001.4"), "{found}");
    }

    #[test]
    fn a_window_sends_back_no_less_than_nothing_and_no_more_than_the_pulse() {
        let found = error(&["cover.fraction=-1e-4"]);
        assert!(
            found.contains("cover.fraction=-1e-4") && found.contains("from 0.0 to 1.0"),
            "{found}"
        );
        let cold = ["cover.temperature_coefficient_per_k=0.05", "spad.temperature_c=-10"];
        let found = error(&[&["cover.fraction=1e-4"], &cold[..]].concat());
        let key = "cover.temperature_coefficient_per_k = 0.05: expected a fraction of 0 at least";
        assert!(found.contains(key), "{found}");
        let found = error(&["cover.dirt_per_h=0.1", "cover.age_h=11"]);
        assert!(
            found.contains("cover.dirt_per_h = 0.1: expected no more than the pulse"),
            "{found}"
        );
        assert_eq!(error(&["cover.dirt_per_h=0.1", "cover.age_h=9"]), "");
    }

    #[test]
    fn fractions_of_pixels_are_those_of_an_array_and_in_place_of_the_whole() {
        let file = "cover.fraction_file=f.csv";
        let found = error(&[file]);
        assert!(
            found.contains("cover.fraction_file = f.csv: expected none, or several"),
            "{found}"
        );
        let found = error(&["array.rows=2", file, "cover.fraction=1e-4"]);
        assert!(found.contains("cover.fraction = 0.0001: expected 0"), "{found}");
        assert_eq!(error(&["array.rows=2", file]), "");
    }
}
