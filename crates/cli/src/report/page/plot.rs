//! Curves by distance.

use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::text::svg::{chart, legend, picture};

/// A curve of the plot.
pub struct Curve<'a> {
    pub name: &'a str,
    /// Distance [m], and what is there [mm].
    pub points: &'a [(f64, f64)],
}

const COLOURS: [RGBColor; 2] = [RGBColor(43, 108, 176), RGBColor(221, 107, 32)];

/// A picture of some curves, upwards by factors or around zero; an error only if the plotting library fails.
pub fn curves(
    title: &str,
    quantity: &str,
    by_factors: bool,
    all: &[Curve],
) -> Result<String, String> {
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
            let (low, high) = (low.max(1e-6) / 1.5, high.max(1e-6) * 1.5);
            let chart = chart.build_cartesian_2d(x.clone(), (low..high).log_scale())?;
            fill(chart, quantity, all)
        } else {
            let reach = low.abs().max(high.abs()).max(1e-6) * 1.1;
            fill(chart.build_cartesian_2d(x.clone(), -reach..reach)?, quantity, all)
        }
    })
}

type Axes<Y> = Cartesian2d<RangedCoordf64, Y>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

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
    mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
    for (curve, colour) in all.iter().zip(COLOURS) {
        draw(&mut chart, curve, colour)?;
    }
    match all {
        [_] => Ok(()),
        _ => legend(&mut chart, SeriesLabelPosition::UpperLeft),
    }
}

/// A line with a dot at each point.
fn draw<Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<SVGBackend, Axes<Y>>,
    curve: &Curve,
    colour: RGBColor,
) -> Drawn {
    let line = LineSeries::new(curve.points.iter().copied(), colour.stroke_width(2));
    chart
        .draw_series(line)?
        .label(curve.name)
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
    chart.draw_series(curve.points.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
    Ok(())
}
