//! A training: the accuracy of the network as table, JSON and CSV, and the learning curve as CSV and picture.

use std::collections::BTreeMap;
use std::path::Path;

use plotters::prelude::*;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim_learn::training::accuracy::{DistanceErrors, worst_ratio};
use tofsim_learn::training::state::CurvePoint;
use tofsim_learn::training::weighting::Weighting;

use crate::text::svg::{chart, picture};
use crate::text::table::fixed;

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
        .words("mean [mm]", |row| fixed(row.mean_mm, 2))
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

/// Returns the curve as CSV, a row for each network at each checkpoint.
pub fn curve_csv(points: &[CurvePoint]) -> String {
    Sheet::of(points)
        .column("stage", Shortest, |point| point.stage)
        .column("block", Shortest, |point| point.block)
        .column("start", Shortest, |point| point.start)
        .column("epochs", Shortest, |point| point.epochs)
        .column("cost", Literal, |point| point.cost)
        .column("mu", Literal, |point| point.mu)
        .column("validation", Literal, |point| point.validation)
        .column("ratio", Literal, |point| point.ratio)
        .csv()
}

/// The curve as SVG text, a line for each start; an error only if the plotting library fails.
pub fn curve_svg(points: &[CurvePoint]) -> Result<String> {
    let mut lines: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
    for point in points.iter().filter(|point| point.cost.is_finite() && point.cost > 0.0) {
        lines.entry(point.start).or_default().push((point.epochs as f64, point.cost));
    }
    let all = || lines.values().flatten();
    let last = all().map(|point| point.0).fold(1.0, f64::max);
    let least = all().map(|point| point.1).fold(1.0, f64::min) / 1.5;
    let most = all().map(|point| point.1).fold(1.0, f64::max) * 1.5;
    // The line that goes on longest was the best.
    let longest = lines.values().map(Vec::len).max().unwrap_or(0);
    picture(|canvas| {
        let mut chart = chart(canvas, "Cost of every start; 1 is the spread to stay below")
            .build_cartesian_2d(0.0..last, (least..most).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("epochs")
            .y_desc("weighted mean square error")
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        for line in lines.into_values() {
            let style = if line.len() == longest {
                RGBColor(43, 108, 176).stroke_width(2)
            } else {
                BLACK.mix(0.3).stroke_width(1)
            };
            chart.draw_series(LineSeries::new(line, style))?;
        }
        Ok(())
    })
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

    #[test]
    fn a_line_for_each_start_and_a_row_for_each_point() {
        let point = |start, epochs, cost| {
            let validation = (start == 1).then_some(2.5);
            CurvePoint { stage: 0, block: 0, start, epochs, cost, mu: 0.1, validation, ratio: None }
        };
        let points = [
            point(0, 3, 5.0),
            point(1, 3, f64::INFINITY),
            point(0, 6, 1.5),
            point(1, 6, 2.0),
            point(0, 9, 1.25),
        ];
        let csv = curve_csv(&points);
        assert!(
            csv.starts_with(
                "stage,block,start,epochs,cost,mu,validation,ratio\n0,0,0,3,5.0,0.1,,\n"
            ),
            "{csv}"
        );
        assert_eq!(csv.lines().count(), 6);
        assert!(csv.ends_with("0,0,1,6,2.0,0.1,2.5,\n0,0,0,9,1.25,0.1,,\n"), "{csv}");
        let svg = curve_svg(&points).unwrap();
        assert!(svg.contains("<polyline") && svg.contains("#2B6CB0"));
        curve_svg(&[]).unwrap();
    }
}
