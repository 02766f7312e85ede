//! Built-in plans.

macro_rules! plans {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../../stimuli/studies/", $name, ".toml"))),)*]
    };
}

/// Name and text of each built-in plan.
pub const PLANS: &[(&str, &str)] = plans!(
    "fig-4-2",
    "fig-4-3",
    "fig-4-4a",
    "fig-4-4b",
    "fig-4-4c",
    "fig-4-4d",
    "fig-4-5a",
    "fig-4-5b",
    "fig-4-6",
    "fig-4-7",
    "fig-4-8ab",
    "fig-4-8cd",
    "fig-4-8ef",
    "fig-4-9ab",
    "fig-4-9cd",
    "table-4-3",
    "least-power",
    "pile-up",
    "weather",
    "rain",
    "shapes",
);

/// Returns the text of a built-in plan.
pub fn plan(name: &str) -> Option<&'static str> {
    PLANS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
