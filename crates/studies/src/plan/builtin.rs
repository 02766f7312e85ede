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

/// Returns name and text of a built-in plan.
pub fn plan(name: &str) -> Option<(&'static str, &'static str)> {
    PLANS.iter().find(|(known, _)| is_name(name, known)).copied()
}

/// Returns whether a name is that of a plan, table or figure, with a hyphen or a point between numbers: `fig-4-2` and
/// `fig-4.2` are the same.
pub fn is_name(given: &str, known: &str) -> bool {
    given.replace('.', "-") == known.replace('.', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_hyphens_or_points() {
        assert_eq!(plan("table-4.3"), plan("table-4-3"));
        assert_eq!(plan("fig-4.2").unwrap().0, "fig-4-2");
        assert!(plan("fig-4.1").is_none() && plan("fig 4.2").is_none());
    }
}
