//! What a training found, as text: a table, JSON and CSV.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use tofsim_learn::training::accuracy::{DistanceErrors, worst_ratio};
use tofsim_learn::training::weighting::Weighting;

use crate::text::table::table as text_table;

/// What `--json` prints, of all distances; `network` is the file that was written.
pub fn json(rows: &[DistanceErrors], line: &Weighting, network: &Path) -> Value {
    let each = |of: &dyn Fn(&DistanceErrors) -> f64| rows.iter().map(of).collect::<Vec<_>>();
    json!({
        "schema": "tofsim.train/1",
        "network": network.display().to_string(),
        // Largest ratio of a spread, twice the standard deviation in fixed point, to the line.
        "worst_ratio": worst_ratio(rows, line),
        "distances_m": each(&|row| row.distance_m),
        "mean_mm": each(&|row| row.mean_mm),
        "two_sd_mm": each(&|row| row.two_sd_mm),
        // What to stay below; Table 5.5 of the thesis, unless the recipe says otherwise.
        "line_mm": each(&|row| line.line_mm(row.distance_m)),
    })
}

/// Rounded to hundredths, as files have it.
pub fn hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A row for each distance, as CSV.
pub fn csv(rows: &[DistanceErrors]) -> String {
    let mut text = String::from("distance_m,histograms,mean_mm,two_sd_mm,rms_mm\n");
    for DistanceErrors { distance_m, count, mean_mm, two_sd_mm, rms_mm } in rows {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{distance_m},{count},{mean_mm:?},{two_sd_mm:?},{rms_mm:?}");
    }
    text
}

/// The line's distances, and the worst of all, for people.
pub fn table(rows: &[DistanceErrors], line: &Weighting) -> String {
    let shown = rows.iter().filter(|row| line.distances_m.contains(&row.distance_m));
    let shown = shown.map(|row| {
        let below = format!("{:.2}", line.line_mm(row.distance_m));
        let [mean, spread] = [row.mean_mm, row.two_sd_mm].map(|value| format!("{value:.2}"));
        [row.distance_m.to_string(), mean, spread, below]
    });
    let table = text_table(["distance_m", "mean_mm", "two_sd_mm", "to stay below"], shown, ..);
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
        let json = json(&rows, &Weighting::default(), path);
        assert_eq!(json["two_sd_mm"][1], 2.5);
        assert_eq!(json["line_mm"][0], 1.6);
        assert_eq!(json["network"], "a/network.toml");
    }
}
