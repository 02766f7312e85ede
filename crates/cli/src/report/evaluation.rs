//! An evaluation as tables, beside the thesis's.

use comfy_table::{CellAlignment, Table};

use tofsim_learn::evaluation::thesis::{self, DISTANCES_M, Published};
use tofsim_learn::evaluation::{Figures, Spread};

use crate::text::table::plain;

/// Twice the standard deviation, the mean and the failures at the thesis's distances, with its own
/// rows; `bound_mm` is the Cramer-Rao bound there.
pub fn tables(figures: &[Figures], bound_mm: &[Option<f64>]) -> String {
    let mut spreads = table("2 sd [mm]");
    let mut means = table("mean error [mm]");
    let mut failures = table("failures");
    for published in [&thesis::FLOAT, &thesis::FIXED, &thesis::PEAK] {
        published_row(&mut spreads, published, &published.two_sd_mm, 1);
        published_row(&mut means, published, &published.mean_mm, 1);
    }
    for one in figures {
        row(&mut spreads, one, |spread| with_error(spread.two_sd_mm, spread.two_sd_error_mm));
        row(&mut means, one, |spread| with_error(spread.mean_mm, spread.mean_error_mm));
        row(&mut failures, one, |spread| {
            let histograms = spread.estimates + spread.failures;
            format!("{} of {histograms}", spread.failures)
        });
    }
    let cell = |mm: &Option<f64>| mm.map_or("-".to_owned(), |mm| format!("{mm:.2}"));
    let cells = bound_mm.iter().map(cell);
    spreads.add_row(["Cramer-Rao bound".to_owned()].into_iter().chain(cells));
    let trials = thesis::PEAK_TRIALS;
    let cells = thesis::PEAK_FAILURES.map(|failures| format!("{failures} of {trials}"));
    failures
        .add_row([vec!["thesis, peak detection (Table 4.3)".to_owned()], cells.to_vec()].concat());
    let tables = [spreads, means, failures].map(|table| format!("{}\n", table.trim_fmt()));
    tables.join("\n")
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

fn table(title: &str) -> Table {
    let mut table = plain();
    let distances = DISTANCES_M.map(|distance_m| format!("{distance_m} m"));
    table.set_header([vec![title.to_owned()], distances.to_vec()].concat());
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn published_row(table: &mut Table, published: &Published, values: &[f64; 6], decimals: usize) {
    let cells = values.map(|mm| format!("{mm:.decimals$}"));
    table.add_row([vec![published.name.to_owned()], cells.to_vec()].concat());
}

fn row(table: &mut Table, figures: &Figures, cell: impl Fn(&Spread) -> String) {
    let mut cells = vec![figures.name.to_owned()];
    for distance_m in DISTANCES_M {
        cells.push(figures.at(distance_m).map_or("-".to_owned(), &cell));
    }
    table.add_row(cells);
}

fn with_error(value_mm: Option<f64>, error_mm: Option<f64>) -> String {
    match (value_mm, error_mm) {
        (Some(value), Some(error)) => format!("{value:.2} +-{error:.2}"),
        (Some(value), None) => format!("{value:.2}"),
        (None, _) => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim_learn::dataset::Scene;
    use tofsim_learn::evaluation::{Column, Evaluation};

    #[test]
    fn a_distance_that_was_not_drawn_has_no_figure() {
        let scene = Scene { distance_m: 0.2, reflectance: 0.3, irradiance_w_m2_nm: 0.0 };
        let errors_m = [-1.0, 1.0].map(|sign| Some(sign / 1e3 / 2f64.sqrt())).to_vec();
        let column = Column { name: "network", errors_m };
        let evaluation = Evaluation { scenes: vec![scene; 2], columns: vec![column.clone()] };
        let figures = Figures::new(&evaluation, &column);
        let text = tables(std::slice::from_ref(&figures), &[Some(0.5); 6]);
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
