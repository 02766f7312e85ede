//! The learning curve as a table and as a picture.

use std::collections::BTreeMap;

use plotters::prelude::*;

use tofsim::error::Result;
use tofsim_learn::training::state::CurvePoint;

use crate::text::svg::{chart, picture};

use super::sheet::Digits::{Literal, Shortest};
use super::sheet::Sheet;

/// Returns the curve as CSV, a row for each network at each checkpoint.
pub fn csv(points: &[CurvePoint]) -> String {
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
pub fn svg(points: &[CurvePoint]) -> Result<String> {
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
        let csv = csv(&points);
        assert!(
            csv.starts_with(
                "stage,block,start,epochs,cost,mu,validation,ratio\n0,0,0,3,5.0,0.1,,\n"
            ),
            "{csv}"
        );
        assert_eq!(csv.lines().count(), 6);
        assert!(csv.ends_with("0,0,1,6,2.0,0.1,2.5,\n0,0,0,9,1.25,0.1,,\n"), "{csv}");
        let svg = svg(&points).unwrap();
        assert!(svg.contains("<polyline") && svg.contains("#2B6CB0"));
        super::svg(&[]).unwrap();
    }
}
