//! An evaluation as tables, beside the thesis's, and as files: JSON, figures as CSV, and box plots.

use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result};
use tofsim::files::output::{create_directory, write_bytes};
use tofsim_learn::evaluation::thesis::{self, Published};
use tofsim_learn::evaluation::{Figures, Group, KeyGroups, Spread};

use crate::text::table::{number_or_dash, table};

use super::box_plot;

/// The columns of `evaluation.csv`.
const HEADER: &str = "estimator,by,value,estimates,failures,outliers,mean_mm,mean_se_mm,two_sd_mm,two_sd_se_mm,\
    least_mm,lower_quartile_mm,median_mm,upper_quartile_mm,largest_mm";

/// What figures lie beside.
pub struct Beside<'a> {
    /// Distances to show; the thesis's own where its rows are shown too [m].
    pub distances_m: &'a [f64],
    /// The Cramer-Rao bound there [mm].
    pub bound_mm: &'a [Option<f64>],
    /// Whether the grid is the thesis's, so that its figures and its line are shown.
    pub thesis: bool,
}

/// Twice the standard deviation, the mean, the outliers and the failures at some distances, with the thesis's rows.
pub fn tables(figures: &[Figures], beside: &Beside) -> String {
    let Beside { distances_m, bound_mm, thesis } = beside;
    let published = |of: fn(&Published) -> [f64; 6]| {
        let row = |row: &Published| named(row.name, of(row).map(|mm| format!("{mm:.1}")));
        let rows = [&thesis::FLOAT, &thesis::FIXED, &thesis::PEAK].map(row).to_vec();
        if *thesis { rows } else { Vec::new() }
    };
    let measured = |cell: fn(&Spread) -> String| -> Vec<_> {
        let at = |one: &Figures, m: &f64| one.at(*m).map_or("-".to_owned(), cell);
        figures.iter().map(|one| named(one.name, distances_m.iter().map(|m| at(one, m)))).collect()
    };
    let two_sd = measured(|spread| with_error(spread.two_sd_mm, spread.two_sd_se_mm));
    let bound = named("Cramer-Rao bound", bound_mm.iter().map(|mm| number_or_dash(*mm, 2)));
    let bound = if bound_mm.is_empty() { Vec::new() } else { vec![bound] };
    let mean = measured(|spread| with_error(spread.mean_mm, spread.mean_se_mm));
    let failed =
        measured(|spread| format!("{} of {}", spread.failures, spread.estimates + spread.failures));
    let far = measured(|spread| format!("{} of {}", spread.outliers, spread.estimates));
    let trials = thesis::PEAK_TRIALS;
    let peak = thesis::PEAK_FAILURES.map(|failures| format!("{failures} of {trials}"));
    let peak = thesis.then(|| named("thesis, peak detection (Table 4.3)", peak));
    let tables = [
        ("2 sd [mm]", [published(|row| row.two_sd_mm), two_sd, bound]),
        ("mean error [mm]", [published(|row| row.mean_mm), mean, Vec::new()]),
        ("outliers", [far, Vec::new(), Vec::new()]),
        ("failures", [failed, peak.into_iter().collect(), Vec::new()]),
    ];
    let text = |(title, rows): (&str, [Vec<Vec<String>>; 3])| {
        let header = named(title, distances_m.iter().map(|distance_m| format!("{distance_m} m")));
        table(header, rows.concat(), 1..) + "\n"
    };
    tables.map(text).join("\n")
}

/// How far an estimator's spread is from the line between those of the thesis's float network, over
/// all distances.
pub fn beside_the_line(figures: &Figures) -> Option<String> {
    Some(format!(
        "{}: 2 sd is at most {:.2} times the line between the thesis's float figures, at {} m; \
         above it at {} of {} distances",
        figures.name,
        figures.worst_ratio_to_thesis?,
        figures.worst_distance_m?,
        figures.distances_above_the_line(),
        figures.by_distance_m.len()
    ))
}

/// The cells of a row that begins with a name.
fn named(name: &str, cells: impl IntoIterator<Item = String>) -> Vec<String> {
    [name.to_owned()].into_iter().chain(cells).collect()
}

fn with_error(value_mm: Option<f64>, error_mm: Option<f64>) -> String {
    let error = error_mm.filter(|_| value_mm.is_some());
    number_or_dash(value_mm, 2) + &error.map_or(String::new(), |error| format!(" +-{error:.2}"))
}

/// The file that is always written.
pub const JSON: &str = "evaluation.json";

/// Puts them in a folder, which is made, with the thesis's line where the grid is the thesis's;
/// `by_setting` has the errors of each by the grid's other keys. Their paths.
pub fn write(
    folder: &Path,
    json: &str,
    figures: &[Figures],
    by_setting: &[Vec<KeyGroups>],
    thesis: bool,
) -> Result<Vec<PathBuf>> {
    create_directory(folder)?;
    let mut paths = vec![folder.join(JSON), folder.join("evaluation.csv")];
    write_bytes(&paths[0], json)?;
    write_bytes(&paths[1], csv(figures, by_setting))?;
    for one in figures {
        for grouping in one.groupings() {
            let beside_mm: Option<fn(f64) -> f64> =
                (thesis && grouping.key == "distance_m").then_some(thesis::line_two_sd_mm);
            let line = beside_mm.map_or("", |_| "; red: 2 sd of the thesis's float network");
            let title = format!("{}: errors by {}{line}", one.name, grouping.quantity);
            let path = folder.join(format!("{}_by_{}.svg", one.name, grouping.key));
            let svg = box_plot::svg(&title, grouping.quantity, grouping.groups, beside_mm);
            let svg = svg.map_err(|why| Input::new(path.display(), why))?;
            write_bytes(&path, svg)?;
            paths.push(path);
        }
    }
    Ok(paths)
}

/// A row for each estimator and group.
fn csv(figures: &[Figures], by_setting: &[Vec<KeyGroups>]) -> String {
    let mut text = format!("{HEADER}\n");
    for one in figures {
        for grouping in one.groupings() {
            for group in grouping.groups {
                text += &format!("{},{},{}\n", one.name, grouping.key, numbers(group));
            }
        }
    }
    for (one, keys) in figures.iter().zip(by_setting) {
        for KeyGroups { key, groups } in keys {
            for group in groups {
                text += &format!("{},{key},{}\n", one.name, numbers(group));
            }
        }
    }
    text
}

/// Errors by the grid's other keys, a table each.
pub fn setting_tables(figures: &[Figures], by_setting: &[Vec<KeyGroups>]) -> String {
    let first = by_setting.first().map_or(&[][..], |keys| keys);
    let text = |(k, KeyGroups { key, .. }): (usize, &KeyGroups)| {
        let rows = figures.iter().zip(by_setting).flat_map(|(one, keys)| {
            keys[k].groups.iter().map(move |Group { value, spread }| {
                [
                    one.name.to_owned(),
                    value.to_string(),
                    with_error(spread.two_sd_mm, spread.two_sd_se_mm),
                    with_error(spread.mean_mm, spread.mean_se_mm),
                    format!("{} of {}", spread.failures, spread.estimates + spread.failures),
                ]
            })
        });
        let header = ["estimator", key, "2 sd [mm]", "mean error [mm]", "failures"];
        format!("\n{}\n", table(header, rows, 1..))
    };
    first.iter().enumerate().map(text).collect()
}

fn numbers(group: &Group) -> String {
    let spread = &group.spread;
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let counts =
        [spread.estimates, spread.failures, spread.outliers].map(|count| count.to_string());
    let moments = [spread.mean_mm, spread.mean_se_mm, spread.two_sd_mm, spread.two_sd_se_mm];
    let quartiles = [0, 1, 2, 3, 4].map(|k| number(spread.quartiles_mm.map(|five| five[k])));
    [&[group.value.to_string()], &counts[..], &moments.map(number), &quartiles].concat().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim_learn::dataset::Scene;
    use tofsim_learn::evaluation::thesis::DISTANCES_M;
    use tofsim_learn::evaluation::{EstimatorErrors, Evaluation};

    #[test]
    fn a_distance_that_was_not_drawn_has_no_figure() {
        let scene = Scene { distance_m: 0.2, reflectance: 0.3, ..Scene::default() };
        let errors_m = [-1.0, 1.0].map(|sign| Some(sign / 1e3 / 2f64.sqrt())).to_vec();
        let column = EstimatorErrors { name: "network", errors_m };
        let evaluation = Evaluation { scenes: vec![scene; 2], columns: vec![column.clone()] };
        let figures = Figures::new(&evaluation, &column, 0.1);
        let beside = Beside { distances_m: &DISTANCES_M, bound_mm: &[Some(0.5); 6], thesis: true };
        let text = tables(std::slice::from_ref(&figures), &beside);
        let row = text.lines().find(|line| line.trim_start().starts_with("network")).unwrap();
        assert_eq!(row.split_whitespace().collect::<Vec<_>>()[1..3], ["-", "2.00"]);
        assert!(text.contains("Table 6.5") && text.contains("2584 of 30000"));
        let line = beside_the_line(&figures).unwrap();
        assert!(
            line.contains("at most 0.71 times") && line.ends_with("0 of 1 distances"),
            "{line}"
        );
    }
}
