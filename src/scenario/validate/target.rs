//! Checks of the target's keys that involve more than one key.

use crate::error::Result;
use crate::files::toml::Checked;
use crate::scenario::model::{Shape, Target};

/// Largest rotation of a flat target, so that its front faces the sensor [deg].
const MOST_TURNED_DEG: f64 = 89.0;

/// Checks the keys that the target's shape uses.
///
/// # Errors
/// The first key that violates a constraint.
pub fn check(target: &Target, checked: &Checked) -> Result<()> {
    let fault = |key: &str, value: &dyn std::fmt::Display, expected: String| {
        Err(checked.fault(key, expected).value(value).into())
    };
    let name = format!("{:?}", target.shape).to_lowercase();
    match (target.shape == Shape::Mesh, &target.mesh_file) {
        (true, None) => {
            let expected = "expected the file of a mesh: target.shape is mesh";
            return Err(checked.fault("target.mesh_file", expected).into());
        }
        (false, Some(file)) => {
            let expected = format!("expected none, or target.shape = mesh: it is {name}");
            return fault("target.mesh_file", file, expected);
        }
        _ => {}
    }
    for (key, deg) in [("target.tilt_deg", target.tilt_deg), ("target.yaw_deg", target.yaw_deg)] {
        if target.is_flat() && deg.abs() > MOST_TURNED_DEG {
            let most = MOST_TURNED_DEG;
            let expected = format!("expected -{most} to {most} with target.shape = {name}");
            return fault(key, &deg, expected);
        }
    }
    if target.shape == Shape::Step && target.second_share > 0.0 {
        let expected =
            "expected 0 with target.shape = step, whose second part is at target.second_distance_m";
        return fault("target.second_share", &target.second_share, expected.to_owned());
    }
    let side_m = target.retro_side_m;
    if side_m == 0.0 {
        return Ok(());
    }
    match target.shape {
        Shape::Rectangle => Ok(()),
        Shape::Disc => {
            let [x, y] = [target.retro_x_m, target.retro_y_m].map(|m| m.abs() + side_m / 2.0);
            if x.hypot(y) <= target.radius_m {
                return Ok(());
            }
            let expected = format!(
                "expected a patch whose corners are on the disc, {} m from its middle at most (target.radius_m)",
                target.radius_m
            );
            fault("target.retro_side_m", &side_m, expected)
        }
        _ => {
            let expected = format!(
                "expected 0 with target.shape = {name}: a patch is on a rectangle or a disc"
            );
            fault("target.retro_side_m", &side_m, expected)
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scenario::load;

    fn error(overrides: &[&str]) -> String {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        load("kc705", &overrides).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_mesh_needs_a_file_and_no_other_shape_has_one() {
        let found = error(&["target.shape=mesh"]);
        assert!(found.contains("target.mesh_file: expected the file of a mesh"), "{found}");
        let found = error(&["target.mesh_file=ball.obj"]);
        assert!(found.contains("target.mesh_file = ball.obj: expected none"), "{found}");
        assert_eq!(error(&["target.shape=mesh", "target.mesh_file=ball.obj"]), "");
    }

    #[test]
    fn a_flat_target_shows_its_front() {
        let found = error(&["target.yaw_deg=-120"]);
        assert!(found.contains("target.yaw_deg = -120: expected -89 to 89"), "{found}");
        let mesh = ["target.shape=mesh", "target.mesh_file=ball.obj", "target.yaw_deg=-120"];
        assert_eq!(error(&mesh), "");
    }

    #[test]
    fn a_step_has_no_further_surface() {
        let found = error(&["target.shape=step", "target.second_share=0.2"]);
        assert!(
            found.contains("target.second_share = 0.2: expected 0 with target.shape = step"),
            "{found}"
        );
        assert_eq!(error(&["target.shape=disc", "target.second_share=0.2"]), "");
    }

    #[test]
    fn a_patch_is_on_a_rectangle_or_within_a_disc() {
        let patch = "target.retro_side_m=0.1";
        assert_eq!(error(&[patch]), "");
        assert_eq!(error(&[patch, "target.shape=disc"]), "");
        let found = error(&[patch, "target.shape=disc", "target.retro_x_m=0.06"]);
        assert!(found.contains("expected a patch whose corners are on the disc"), "{found}");
        let found = error(&[patch, "target.shape=sphere"]);
        assert!(found.contains("target.retro_side_m = 0.1: expected 0"), "{found}");
    }
}
