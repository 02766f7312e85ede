//! Checks of the array's keys that involve more than one key.

use std::fmt::Display;

use crate::error::Result;
use crate::files::toml::Checked;
use crate::scenario::model::{Scenario, Spad};
use crate::scenario::projection::Projection;

/// Checks that the field of view is given once and imaged distinctly, and that each pixel has a diode and light of its
/// own.
///
/// # Errors
/// The first key that violates a constraint.
pub fn check(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let Scenario { array, laser, spad, stimulus, control, .. } = scenario;
    let fault = |key: &str, value: &dyn Display, expected: String| {
        Err(checked.fault(key, expected).value(value).into())
    };
    if let (1, Some(file)) = (array.count(), &array.offset_file) {
        let expected = "expected none, or several pixels (array.rows, array.columns)";
        return fault("array.offset_file", file, expected.to_owned());
    }
    if let (1, Some(file)) = (array.columns, &array.chains_file) {
        let expected =
            "expected none, or several columns (array.columns): tdc.profile is the chain of one";
        return fault("array.chains_file", file, expected.to_owned());
    }
    if !array.is_rectangular() {
        if array.distortion == [0.0; 2] {
            return Ok(());
        }
        let expected = "expected [0, 0], or a rectangular field of view (array.field_of_view_deg): it is a cone";
        return fault("array.distortion", &shown(array.distortion), expected.to_owned());
    }
    if spad.field_of_view_deg != Spad::default().field_of_view_deg {
        let expected = "expected nothing: array.field_of_view_deg, or the illuminated cone, says what pixels see";
        return fault("spad.field_of_view_deg", &spad.field_of_view_deg, expected.to_owned());
    }
    if !Projection::of(array, laser.field_of_illumination_deg).is_distinct() {
        let expected = "expected a lens that images directions of the field of view in their order";
        return fault("array.distortion", &shown(array.distortion), expected.to_owned());
    }
    let of_one = "each pixel has a field of view and a TDC of its own (array)";
    for (key, value, usual) in
        [("spad.on_tdc", spad.on_tdc, 1), ("spad.row_outputs", spad.row_outputs, 0)]
    {
        if value != usual {
            return fault(key, &value, format!("expected {usual}: {of_one}"));
        }
    }
    if array.count() == 1 {
        return Ok(());
    }
    if scenario.firmware.dark_frames {
        let expected = "expected false: an array has no dark frames (array.rows, array.columns)";
        return fault("firmware.dark_frames", &true, expected.to_owned());
    }
    for (key, file) in [
        ("stimulus.photons", &stimulus.photons),
        ("stimulus.codes", &stimulus.codes),
        ("stimulus.histogram", &stimulus.histogram),
    ] {
        if let Some(file) = file {
            return fault(
                key,
                file,
                "expected none: a list is of one pixel (array.rows)".to_owned(),
            );
        }
    }
    if !control.is_empty() {
        let expected = "expected no changes: rows are acquired one after the other (array.rows)";
        return Err(checked.fault("control", expected).value(control.len()).into());
    }
    Ok(())
}

fn shown([k1, k2]: [f64; 2]) -> String {
    format!("[{k1}, {k2}]")
}

#[cfg(test)]
mod tests {
    use crate::scenario::load;

    fn error(overrides: &[&str]) -> String {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        load("kc705", &overrides).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_single_pixel_has_no_offsets_and_a_cone_no_distortion() {
        let (offsets, distortion) = ("array.offset_file=offsets.csv", "array.distortion=[-0.1,0]");
        let view = "array.field_of_view_deg=[20,15]";
        for keys in [&[offsets][..], &[offsets, view]] {
            let found = error(keys);
            assert!(found.contains("array.offset_file = offsets.csv: expected none"), "{found}");
        }
        let found = error(&[distortion]);
        assert!(found.contains("array.distortion = [-0.1, 0]: expected [0, 0]"), "{found}");
        assert_eq!(error(&[distortion, view]), "");
        assert_eq!(error(&["array.columns=2", distortion, offsets]), "");
    }

    #[test]
    fn a_lens_images_every_direction_at_one_place() {
        let found = error(&["array.field_of_view_deg=[70,70]", "array.distortion=[-2,0]"]);
        assert!(found.contains("array.distortion = [-2, 0]: expected a lens"), "{found}");
    }

    #[test]
    fn pixels_have_one_diode_one_field_of_view_and_light_each() {
        for (key, value) in [
            ("spad.field_of_view_deg", "20"),
            ("spad.on_tdc", "2"),
            ("spad.row_outputs", "30"),
            ("firmware.dark_frames", "true"),
            ("stimulus.photons", "photons.csv"),
            ("stimulus.codes", "codes.csv"),
            ("stimulus.histogram", "histogram.csv"),
        ] {
            let set = format!("{key}={value}");
            assert_eq!(error(&[&set]), "", "of a single pixel");
            let found = error(&["array.rows=2", &set]);
            assert!(found.contains(&format!("{key} = {value}: expected")), "{found}");
        }
        let found = error(&["array.rows=2", "control=[{at_us=1,laser_en=false}]"]);
        assert!(found.contains("control = 1: expected no changes"), "{found}");
    }
}
