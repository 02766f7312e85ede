//! Lines over a column, one for each value of a series, with standard errors and limits.

use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use tofsim_studies::plan::file::{LimitLine, Plot};
use tofsim_studies::table::{Cell, Field, Row};

use crate::text::svg::{COLOURS, Drawn, chart, legend, picture};

use super::axes::{place, range, tick};

/// The part of a picture's height that a line of the legend takes [1].
const LEGEND_LINE: f64 = 0.046;
/// Colours of limits along the vertical axis and along the horizontal one.
const LIMITS: [RGBColor; 2] = [RGBColor(200, 30, 30), RGBColor(128, 0, 128)];

/// A line: its name, and its points with their standard errors.
pub struct SweepLine {
    /// Name in the legend.
    pub name: String,
    /// Across, up, and the standard error of that.
    pub points: Vec<(f64, f64, Option<f64>)>,
}

/// The picture; an error if no row has a value.
pub fn svg(plot: &Plot, fields: &[Field], rows: &[Row]) -> Result<String, String> {
    let lines = lines(plot, fields, rows);
    let points = || lines.iter().flat_map(|line| &line.points);
    let at = |of: fn(&LimitLine) -> Option<f64>| plot.limits.iter().filter_map(of);
    let x = range(points().map(|(x, ..)| *x).chain(at(|limit| limit.x)), plot.log_x);
    let heights = points().flat_map(|(_, y, se)| {
        let se = se.unwrap_or(0.0);
        let low = if plot.log_y && *y - se <= 0.0 { *y } else { *y - se };
        [low, *y + se]
    });
    let y = range(heights.chain(at(|limit| limit.y)), plot.log_y);
    let (Some([left, right]), Some([low, high])) = (x, y) else {
        return Err("no point has what the plot shows".to_owned());
    };
    // Room above the lines for what they stand for.
    let legend = (LEGEND_LINE * (lines.len() + plot.limits.len()) as f64).min(0.5);
    let room = legend / (1.0 - legend);
    let high = if plot.log_y { high * (high / low).powf(room) } else { high + room * (high - low) };
    picture(|canvas| {
        let mut chart = chart(canvas, &plot.title);
        let frame = PlotFrame { plot, lines: &lines, ends: [left, right, low, high] };
        match (plot.log_x, plot.log_y) {
            (false, false) => frame.fill(chart.build_cartesian_2d(left..right, low..high)?),
            (true, false) => {
                frame.fill(chart.build_cartesian_2d((left..right).log_scale(), low..high)?)
            }
            (false, true) => {
                frame.fill(chart.build_cartesian_2d(left..right, (low..high).log_scale())?)
            }
            (true, true) => {
                let (x, y) = ((left..right).log_scale(), (low..high).log_scale());
                frame.fill(chart.build_cartesian_2d(x, y)?)
            }
        }
    })
    .map_err(|fault| fault.to_string())
}

/// The lines of a plot, each in rising order.
pub fn lines(plot: &Plot, fields: &[Field], rows: &[Row]) -> Vec<SweepLine> {
    let x = place(fields, &plot.x);
    let series: Vec<_> = plot.series.iter().filter_map(|name| place(fields, name)).collect();
    let mut lines: Vec<SweepLine> = Vec::new();
    for name in &plot.y {
        let (y, se) = (place(fields, name), place(fields, &format!("{name}_se")));
        for row in rows {
            let number = |place: Option<usize>| row.cells.get(place?).and_then(Cell::as_number);
            let (Some(x), Some(y)) = (number(x), number(y)) else { continue };
            if (plot.log_x && x <= 0.0) || (plot.log_y && y <= 0.0) {
                continue;
            }
            let of =
                series.iter().map(|&k| format!("{} = {}", fields[k].name, row.cells[k].text()));
            let name = (series.is_empty() || plot.y.len() > 1).then(|| name.clone());
            let label = name.into_iter().chain(of).collect::<Vec<_>>().join(", ");
            let line = match lines.iter().position(|line| line.name == label) {
                Some(place) => &mut lines[place],
                None => {
                    lines.push(SweepLine { name: label, points: Vec::new() });
                    let last = lines.len() - 1;
                    &mut lines[last]
                }
            };
            line.points.push((x, y, number(se)));
        }
    }
    for line in &mut lines {
        line.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    lines
}

struct PlotFrame<'a> {
    plot: &'a Plot,
    lines: &'a [SweepLine],
    /// Left, right, low and high.
    ends: [f64; 4],
}

impl PlotFrame<'_> {
    fn fill<'a, 'b: 'a, X, Y>(
        &self,
        mut chart: ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Drawn
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let plot = self.plot;
        let y_names = plot.y.join(", ");
        chart
            .configure_mesh()
            .x_desc(plot.x_label.as_deref().unwrap_or(&plot.x))
            .y_desc(plot.y_label.as_deref().unwrap_or(&y_names))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 16))
            .x_label_formatter(&label)
            .y_label_formatter(&label)
            .draw()?;
        for (line, colour) in self.lines.iter().zip(COLOURS.iter().cycle()) {
            let style = colour.stroke_width(2);
            let points = line.points.iter().map(|(x, y, _)| (*x, *y));
            chart
                .draw_series(LineSeries::new(points.clone(), style))?
                .label(&line.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 14, y)], style));
            chart.draw_series(points.map(|point| Circle::new(point, 3, colour.filled())))?;
            let bars = line.points.iter().filter_map(|(x, y, se)| {
                let (se, floor) = ((*se)?, self.ends[2]);
                Some(PathElement::new([(*x, (y - se).max(floor)), (*x, y + se)], colour.mix(0.6)))
            });
            chart.draw_series(bars)?;
        }
        let [left, right, low, high] = self.ends;
        for limit in &plot.limits {
            let (ends, colour) = match (limit.x, limit.y) {
                (Some(x), _) => ([(x, low), (x, high)], LIMITS[1]),
                (None, Some(y)) => ([(left, y), (right, y)], LIMITS[0]),
                (None, None) => continue,
            };
            let style = colour.mix(0.8).stroke_width(1);
            chart
                .draw_series([DashedPathElement::new(ends, 6, 4, style)])?
                .label(&limit.label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 14, y)], style));
        }
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    }
}

/// A number along an axis.
fn label(number: &f64) -> String {
    tick(*number)
}
