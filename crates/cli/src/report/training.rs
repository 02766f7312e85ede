//! The accuracy of a trained network: a table, JSON and CSV.

use std::path::Path;

use serde_json::{Value, json};

use tofsim_learn::training::accuracy::{DistanceErrors, worst_ratio};
use tofsim_learn::training::weighting::Weighting;

use super::sheet::Digits::{Literal, Shortest};
use super::sheet::Sheet;
use super::writer::Findings;

/// The accuracy of a network by distance.
pub struct TrainingFindings<'a> {
    /// Errors at each distance.
    pub rows: &'a [DistanceErrors],
    /// Spread to stay below.
    pub line: &'a Weighting,
    /// The network's file.
    pub network: &'a Path,
}

impl Findings for TrainingFindings<'_> {
    const SCHEMA: &'static str = "tofsim.train/1";

    fn json(&self) -> Value {
        let TrainingFindings { rows, line, network } = self;
        let each = |of: &dyn Fn(&DistanceErrors) -> f64| rows.iter().map(of).collect::<Vec<_>>();
        json!({
            "network": network.display().to_string(),
            // Largest ratio of a spread, twice the standard deviation in fixed point, to the line.
            "worst_ratio": worst_ratio(rows, line),
            "distances_m": each(&|row| row.distance_m),
            "mean_mm": each(&|row| row.mean_mm),
            "two_sd_mm": each(&|row| row.two_sd_mm),
            // Table 5.5 of the thesis, unless the recipe says otherwise.
            "line_mm": each(&|row| line.line_mm(row.distance_m)),
        })
    }

    fn text(&self) -> String {
        table(self.rows, self.line)
    }
}

/// Rounded to hundredths, as files have it.
pub fn hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// Returns a row for each distance, as CSV.
pub fn csv(rows: &[DistanceErrors]) -> String {
    Sheet::of(rows)
        .column("distance_m", Shortest, |row| row.distance_m)
        .column("histograms", Shortest, |row| row.count)
        .column("mean_mm", Literal, |row| row.mean_mm)
        .column("two_sd_mm", Literal, |row| row.two_sd_mm)
        .column("rms_mm", Literal, |row| row.rms_mm)
        .csv()
}

/// The line's distances, and the worst of all, for people.
fn table(rows: &[DistanceErrors], line: &Weighting) -> String {
    let is_shown = |row: &&DistanceErrors| line.distances_m.contains(&row.distance_m);
    let shown: Vec<_> = rows.iter().filter(is_shown).collect();
    let table = Sheet::of(&shown)
        .words("distance [m]", |row| row.distance_m)
        .words("mean [mm]", |row| format!("{:.2}", row.mean_mm))
        .words("2 sigma [mm]", |row| format!("{:.2}", row.two_sd_mm))
        .words("to stay below", |row| format!("{:.2}", line.line_mm(row.distance_m)))
        .table();
    let ratio = |row: &DistanceErrors| row.two_sd_mm / line.line_mm(row.distance_m);
    let worst = rows.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    let worst = worst.map_or(String::new(), |row| {
        let (ratio, distance) = (ratio(row), row.distance_m);
        format!("fixed point; over all distances at most {ratio:.2} of that, at {distance} m\n")
    });
    format!("{table}\n{worst}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(distance_m: f64, two_sd_mm: f64) -> DistanceErrors {
        DistanceErrors { distance_m, count: 3, mean_mm: -0.25, two_sd_mm, rms_mm: 1.0 }
    }

    #[test]
    fn the_table_has_the_line_s_distances_and_the_worst_of_all() {
        let rows = [row(0.1, 1.0), row(0.15, 6.6), row(0.2, 2.0)];
        let text = table(&rows, &Weighting::default());
        assert!(text.contains("1.60") && text.contains("-0.25") && !text.contains("6.60"));
        assert!(text.ends_with("at most 3.00 of that, at 0.15 m\n"), "{text}");
    }

    #[test]
    fn csv_and_json_have_all_distances() {
        let rows = [row(0.1, 1.5), row(0.15, 2.5)];
        let csv = csv(&rows);
        assert!(csv.ends_with("0.1,3,-0.25,1.5,1.0\n0.15,3,-0.25,2.5,1.0\n"), "{csv}");
        let path = Path::new("a/network.toml");
        let line = &Weighting::default();
        let json = TrainingFindings { rows: &rows, line, network: path }.json();
        assert_eq!(json["two_sd_mm"][1], 2.5);
        assert_eq!(json["line_mm"][0], 1.6);
        assert_eq!(json["network"], "a/network.toml");
    }
}
