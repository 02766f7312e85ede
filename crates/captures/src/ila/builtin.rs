//! Built-in probe configurations: an array's, the thesis's screen captures, the likelihood estimator's, and a shot.

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$((
            $name,
            include_str!(concat!("../../../../stimuli/ila/", $name, ".toml")),
        ),)*]
    };
}

/// Name and text of each built-in configuration.
pub const SET_UPS: &[(&str, &str)] =
    files!("array", "fig_6_6", "fig_6_12", "fig_6_13", "fig_6_21", "likelihood_estimator", "shot");

/// Returns the text of a built-in configuration.
pub fn set_up(name: &str) -> Option<&'static str> {
    SET_UPS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
