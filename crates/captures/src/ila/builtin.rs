//! Set-ups built into the program: the thesis's screen captures, the likelihood estimator's, and a shot.

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$((
            $name,
            include_str!(concat!("../../../../stimuli/ila/", $name, ".toml")),
        ),)*]
    };
}

/// Name and text of each built-in set-up.
pub const SET_UPS: &[(&str, &str)] =
    files!("fig_6_6", "fig_6_12", "fig_6_13", "fig_6_21", "likelihood_estimator", "shot");

/// The text of a built-in set-up.
pub fn set_up(name: &str) -> Option<&'static str> {
    SET_UPS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
