//! Curves by distance.

use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use tofsim::error::Result;

use crate::text::svg::{COLOURS, Drawn, chart, legend, picture};

/// A curve of the plot.
pub struct Curve<'a> {
    name: &'a str,
    points: &'a [(f64, f64)],
    /// Nothing is below it.
    is_bound: bool,
}

impl<'a> Curve<'a> {
    /// Creates a curve of a quantity [mm] over distance [m].
    pub fn new(name: &'a str, points: &'a [(f64, f64)]) -> Self {
        Curve { name, points, is_bound: false }
    }

    /// The Cramer-Rao bound, dashed and black.
    pub fn bound(points: &'a [(f64, f64)]) -> Self {
        Curve { name: "Cramer-Rao bound", points, is_bound: true }
    }
}

/// The part of a picture's height that a line of the legend takes.
const LEGEND_LINE: f64 = 0.055;
/// Curves of more points have no dots.
const MOST_DOTS: usize = 12;

/// A picture of some curves, upwards by factors or around zero; an error only if the plotting library fails.
pub fn curves(title: &str, quantity: &str, by_factors: bool, all: &[Curve]) -> Result<String> {
    let points = || all.iter().flat_map(|curve| curve.points);
    if points().next().is_none() {
        return Ok(String::new());
    }
    let least = points().map(|(m, _)| *m).fold(f64::INFINITY, f64::min);
    let most = points().map(|(m, _)| *m).fold(0.0, f64::max);
    let x = least..most.max(least * (1.0 + 1e-6));
    let low = points().map(|(_, mm)| *mm).fold(f64::INFINITY, f64::min);
    let high = points().map(|(_, mm)| *mm).fold(f64::NEG_INFINITY, f64::max);
    picture(|canvas| {
        let mut chart = chart(canvas, title);
        if by_factors {
            let (low, high) = (low.max(1e-6) / 1.3, high.max(1e-6) * 1.3);
            let lines = if all.len() > 1 { all.len() as f64 } else { 0.0 };
            let legend = (LEGEND_LINE * lines).min(0.5);
            let high = high * (high / low).powf(legend / (1.0 - legend));
            let heights = (low..high).log_scale().with_key_points(round_numbers(low, high));
            let chart = chart.build_cartesian_2d(x.clone(), heights)?;
            fill(chart, quantity, all)
        } else {
            let reach = low.abs().max(high.abs()).max(1e-6) * 1.1;
            fill(chart.build_cartesian_2d(x.clone(), -reach..reach)?, quantity, all)
        }
    })
}

/// 1, 2 and 5 times the powers of ten from `low` to `high`.
fn round_numbers(low: f64, high: f64) -> Vec<f64> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let all = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)));
    all.filter(|number| (low..=high).contains(number)).collect()
}

type Axes<Y> = Cartesian2d<RangedCoordf64, Y>;

/// Draws axes, curves and what they stand for.
fn fill<'a, 'b: 'a, Y>(
    mut chart: ChartContext<'a, SVGBackend<'b>, Axes<Y>>,
    quantity: &str,
    all: &[Curve],
) -> Drawn
where
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("distance [m]").y_desc(quantity).label_style(("sans-serif", 14));
    let number = |mm: &f64| format!("{}", (1e6 * mm).round() / 1e6);
    mesh.y_label_formatter(&number).axis_desc_style(("sans-serif", 16));
    mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
    for (curve, colour) in all.iter().zip(COLOURS.into_iter().cycle()) {
        draw(&mut chart, curve, colour)?;
    }
    match all {
        [_] => Ok(()),
        _ => legend(&mut chart, SeriesLabelPosition::UpperLeft),
    }
}

/// A line, with a dot at each of a few points; that of a bound is dashed.
fn draw<Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<SVGBackend, Axes<Y>>,
    curve: &Curve,
    colour: RGBColor,
) -> Drawn {
    let points = curve.points.iter().copied();
    if curve.is_bound {
        let style = BLACK.stroke_width(2);
        let line = DashedLineSeries::new(points, 6, 4, style);
        let dashes = move |(x, y)| DashedPathElement::new([(x, y), (x + 18, y)], 6, 4, style);
        chart.draw_series(line)?.label(curve.name).legend(dashes);
        return Ok(());
    }
    let style = colour.stroke_width(2);
    let line = move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style);
    chart.draw_series(LineSeries::new(points.clone(), style))?.label(curve.name).legend(line);
    if curve.points.len() <= MOST_DOTS {
        chart.draw_series(points.map(|point| Circle::new(point, 3, colour.filled())))?;
    }
    Ok(())
}
