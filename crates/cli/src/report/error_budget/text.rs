//! An error budget for people, within 80 columns.

use tofsim_learn::error_budget::figures::{ErrorChange, ErrorFigures};
use tofsim_learn::error_budget::state::EffectState;
use tofsim_learn::error_budget::{Bound, DepthBudget, EffectErrors};

use crate::text::table::{fixed, grouped, number_or_dash, signed, signed_or_dash, table};
use crate::text::wrap::wrapped;

use super::files::DepthBudgets;

/// Columns of a terminal.
const WIDTH: usize = 80;

/// Tables of each point, with what is off or left out below.
pub fn text(of: &DepthBudgets) -> String {
    let point = |(value, budget): &(f64, DepthBudget)| {
        let at = of.key.map(|key| format!("{key} = {value}\n\n")).unwrap_or_default();
        at + &one(budget)
    };
    of.points.iter().map(point).collect::<Vec<_>>().join("\n")
}

fn one(budget: &DepthBudget) -> String {
    let frames = grouped(budget.frames);
    let head = format!(
        "Errors of {} at {} m [mm], {frames} frames a row\n2σ of a single effect includes shot noise\n\n",
        budget.kind.name(),
        budget.distance_m,
    );
    let changes = "\n\nWhat an effect changes, by the same random numbers [mm, mm^2]\n\n";
    [
        head,
        figures(budget),
        changes.to_owned(),
        differences(budget),
        String::from("\n\n"),
        below(budget),
    ]
    .concat()
}

fn figures(budget: &DepthBudget) -> String {
    let cells = |name: &str, alone: Option<&ErrorFigures>, all_but: Option<&ErrorFigures>| {
        let pair = |of: Option<&ErrorFigures>| match of {
            Some(of) => [bias(of.mean_mm, of.mean_se_mm), spread(of.two_sd_mm, of.two_sd_se_mm)],
            None => ["-", "-"].map(str::to_owned),
        };
        let [[a, b], [c, d]] = [pair(alone), pair(all_but)];
        [name.to_owned(), a, b, c, d]
    };
    let off = budget.none;
    let rows = [cells("all off", Some(&off), None)];
    let rows = rows.into_iter().chain(
        measured(budget)
            .map(|row| cells(row.effect.name(), row.alone.as_ref(), row.all_but.as_ref())),
    );
    let rows = rows.chain([cells("all together", None, Some(&budget.together))]);
    table(["effect", "bias alone", "2σ alone", "bias, all but", "2σ, all but"], rows, 1..)
}

fn differences(budget: &DepthBudget) -> String {
    let pair = |of: Option<&ErrorChange>| match of {
        Some(of) => [bias(of.mean_mm, of.mean_se_mm), bias(of.variance_mm2, of.variance_se_mm2)],
        None => ["-", "-"].map(str::to_owned),
    };
    let rows = measured(budget).map(|row| {
        let [[a, b], [c, d]] = [pair(row.adds.as_ref()), pair(row.takes.as_ref())];
        [row.effect.name().to_owned(), a, b, c, d]
    });
    table(["effect", "bias, alone", "variance", "bias, in all", "variance"], rows, 1..)
}

/// Bound, sums, failures, and the effects that are not measured.
fn below(budget: &DepthBudget) -> String {
    let mut lines = vec![
        wrapped(&bound(&budget.bound), WIDTH, ["", "  "]),
        format!(
            "alone in sum: bias {} mm, 2σ {:.3} mm; together {} and {} mm",
            signed(budget.sum_mean_mm, 3),
            budget.sum_two_sd_mm,
            signed_or_dash(budget.together.mean_mm, 3),
            number_or_dash(budget.together.two_sd_mm, 3),
        ),
    ];
    lines.extend(missing(budget));
    for (title, is_of) in [
        ("off", (|state| matches!(state, EffectState::Off(_))) as fn(&EffectState) -> bool),
        ("left out, and on in every row", |state| matches!(state, EffectState::LeftOut(_))),
    ] {
        let rows: Vec<_> = budget.effects.iter().filter(|row| is_of(&row.state)).collect();
        if rows.is_empty() {
            continue;
        }
        lines.push(format!("\n{title}:"));
        lines.extend(rows.into_iter().map(|row| match &row.state {
            EffectState::Off(why) | EffectState::LeftOut(why) => {
                wrapped(&format!("{}: {why}", row.effect.name()), WIDTH, ["  ", "    "])
            }
            EffectState::On => String::new(),
        }));
    }
    lines.join("\n") + "\n"
}

fn bound(bound: &Bound) -> String {
    if bound.two_sd_mm.is_none() && bound.fine_two_sd_mm.is_none() {
        let why = bound.invalid_because.unwrap_or("no laser light returns");
        return format!("Cramer-Rao bound: none, because {why}");
    }
    format!(
        "Cramer-Rao bound: 2σ of {} mm; {} mm in exact bins an eighth as wide",
        number_or_dash(bound.two_sd_mm, 3),
        number_or_dash(bound.fine_two_sd_mm, 3),
    )
}

/// Returns the largest numbers of failures and outliers over the variants that are shown.
fn missing(budget: &DepthBudget) -> Option<String> {
    let rows = measured(budget).flat_map(|row| [row.alone, row.all_but]).flatten();
    let most = |of: fn(&ErrorFigures) -> u64| {
        rows.clone()
            .chain([budget.none, budget.together])
            .map(|figures| of(&figures))
            .max()
            .unwrap_or(0)
    };
    let (failures, outliers) = (most(|of| of.failures), most(|of| of.outliers));
    (failures + outliers > 0).then(|| {
        format!(
            "frames of a row without a depth: up to {failures}; 0.1 m off or more: up to {outliers}"
        )
    })
}

fn measured(budget: &DepthBudget) -> impl Iterator<Item = &EffectErrors> + Clone {
    budget.effects.iter().filter(|row| row.state == EffectState::On)
}

fn bias(value: Option<f64>, error: Option<f64>) -> String {
    with_error(value, error, signed)
}

fn spread(value: Option<f64>, error: Option<f64>) -> String {
    if value == Some(0.0) { "0".to_owned() } else { with_error(value, error, fixed) }
}

/// Formats a value with its standard error, if that is known.
fn with_error(value: Option<f64>, error: Option<f64>, format: fn(f64, usize) -> String) -> String {
    let Some(value) = value else { return "-".to_owned() };
    let digits = decimals(value, error.unwrap_or(0.0));
    let error = error.map_or(String::new(), |error| format!(" +-{error:.digits$}"));
    format(value, digits) + &error
}

/// Returns the decimals with which the larger of both has four digits at most.
fn decimals(value: f64, error: f64) -> usize {
    match value.abs().max(error) {
        ..9.9995 => 3,
        ..99.995 => 2,
        ..999.95 => 1,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_bound_has_a_reason() {
        let reason = |invalid_because| bound(&Bound { invalid_because, ..Bound::default() });
        let expected = "Cramer-Rao bound: none, because the pulse energy differs from shot to shot";
        assert_eq!(reason(Some("the pulse energy differs from shot to shot")), expected);
        assert_eq!(reason(None), "Cramer-Rao bound: none, because no laser light returns");
    }

    #[test]
    fn numbers_have_as_many_decimals_as_fit() {
        assert_eq!(bias(Some(-0.01234), Some(0.00021)), "-0.012 +-0.000");
        assert_eq!(bias(Some(-0.0001), Some(0.0002)), "+0.000 +-0.000");
        assert_eq!([bias(Some(1.5), None), spread(Some(1.5), None)], ["+1.500", "1.500"]);
        assert_eq!(bias(Some(12.3456), Some(0.123)), "+12.35 +-0.12");
        assert_eq!(spread(Some(0.5), Some(99.999)), "0.5 +-100.0");
        assert_eq!([spread(Some(0.0), Some(0.0)), bias(None, None)], ["0", "-"]);
        for value in [9.9996, 99.996, 999.96, -9.9996] {
            assert!(
                bias(Some(value), Some(value)).len() <= 14 + 1,
                "{}",
                bias(Some(value), Some(value))
            );
        }
    }
}
