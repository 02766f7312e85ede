//! A plot that can be read on a phone: few large words, and a canvas that is not wide.

use std::ops::Range;

use plotters::prelude::*;

use tofsim::error::Result;

use crate::text::svg::{Canvas, Drawn, legend, picture_of};

/// Width and height [px].
const SIZE: (u32, u32) = (660, 400);
/// Part of the height that a line of the legend takes, and its border [1].
const LEGEND_LINE: f64 = 0.062;

pub const BLUE: RGBColor = RGBColor(43, 108, 176);
pub const ORANGE: RGBColor = RGBColor(221, 107, 32);
pub const GREY: RGBColor = RGBColor(113, 128, 150);

/// Shapes of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Bars from the axis up, each as wide as the distance to the next.
    Bars,
    Line,
    Dashes,
    Dots,
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Layer {
    /// For the legend; without it the layer has no entry there.
    pub name: String,
    pub colour: RGBColor,
    pub shape: Shape,
    pub points: Vec<(f64, f64)>,
}

impl Layer {
    pub fn new(
        name: impl Into<String>,
        colour: RGBColor,
        shape: Shape,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Layer { name: name.into(), colour, shape, points: points.into_iter().collect() }
    }

    /// A dashed line from one point to another.
    pub fn between(name: impl Into<String>, colour: RGBColor, ends: [(f64, f64); 2]) -> Self {
        Layer::new(name, colour, Shape::Dashes, ends)
    }
}

/// Layers over two axes.
#[derive(Clone, Debug)]
pub struct Plot<'a> {
    pub title: &'a str,
    /// Labels of the axes, with units.
    pub axes: [&'a str; 2],
    pub layers: Vec<Layer>,
}

impl Plot<'_> {
    /// The picture as SVG text; an error only if the plotting library fails.
    pub fn svg(&self) -> Result<String> {
        let points = || self.layers.iter().flat_map(|layer| &layer.points);
        if points().next().is_none() {
            return Ok(String::new());
        }
        let has_bars = self.layers.iter().any(|layer| layer.shape == Shape::Bars);
        let x = range(points().map(|point| point.0), 0.0);
        let names = self.layers.iter().filter(|layer| !layer.name.is_empty()).count();
        let legend = (LEGEND_LINE * (names as f64 + 1.0)).min(0.6);
        let mut y = range(points().map(|point| point.1), legend / (1.0 - legend));
        y.start = if has_bars { y.start.min(0.0) } else { y.start - 0.08 * (y.end - y.start) };
        picture_of(SIZE, |canvas| self.draw(canvas, x, y))
    }

    fn draw(&self, canvas: &Canvas, x: Range<f64>, y: Range<f64>) -> Drawn {
        let mut chart = ChartBuilder::on(canvas);
        chart.margin(8).caption(self.title, ("sans-serif", 18));
        chart.x_label_area_size(44).y_label_area_size(66);
        let mut chart = chart.build_cartesian_2d(x, y)?;
        let number = |value: &f64| format!("{}", (1e6 * value).round() / 1e6);
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(self.axes[0]).y_desc(self.axes[1]).x_labels(8).y_labels(6);
        mesh.label_style(("sans-serif", 15)).axis_desc_style(("sans-serif", 16));
        mesh.x_label_formatter(&number).y_label_formatter(&number);
        mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
        for layer in &self.layers {
            let (colour, points) = (layer.colour, layer.points.iter().copied());
            let thick = colour.stroke_width(2);
            let drawn = match layer.shape {
                Shape::Bars => {
                    let pairs = layer.points.windows(2);
                    let bar = |pair: &[(f64, f64)]| {
                        Rectangle::new([(pair[0].0, 0.0), (pair[1].0, pair[0].1)], colour.filled())
                    };
                    chart.draw_series(pairs.filter(|pair| pair[0].1 != 0.0).map(bar))?
                }
                Shape::Line => chart.draw_series(LineSeries::new(points, thick))?,
                Shape::Dashes => chart.draw_series(DashedLineSeries::new(points, 7, 4, thick))?,
                Shape::Dots => {
                    chart.draw_series(points.map(|point| Circle::new(point, 3, colour.filled())))?
                }
            };
            if !layer.name.is_empty() {
                drawn.label(&layer.name).legend(move |(x, y)| {
                    Rectangle::new([(x, y - 3), (x + 14, y + 3)], colour.filled())
                });
            }
        }
        if self.layers.iter().any(|layer| !layer.name.is_empty()) {
            legend(&mut chart, SeriesLabelPosition::UpperRight)
        } else {
            Ok(())
        }
    }
}

/// Returns the range from the least to the largest value, and a part of that above.
fn range(values: impl Iterator<Item = f64> + Clone, above: f64) -> Range<f64> {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(f64::NEG_INFINITY, f64::max);
    let reach = (most - least).max(1e-9 * most.abs()).max(1e-12);
    least..most + above * reach + if most == least { reach } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layer_is_drawn_and_named() {
        let bars =
            Layer::new("hits", BLUE, Shape::Bars, [(0.0, 3.0), (1.0, 0.0), (2.0, 5.0), (3.0, 0.0)]);
        let mark = Layer::between("truth", ORANGE, [(1.5, 0.0), (1.5, 5.0)]);
        let plot = Plot { title: "a", axes: ["x [m]", "y"], layers: vec![bars, mark] };
        let svg = plot.svg().unwrap();
        for word in ["hits", "truth", "x [m]", "viewBox"] {
            assert!(svg.contains(word), "{word}: {svg}");
        }
        assert_eq!(plot.svg().unwrap(), svg);
        assert_eq!(Plot { layers: Vec::new(), ..plot }.svg().unwrap(), "");
    }

    #[test]
    fn a_single_value_has_a_scale() {
        let dot = Layer::new("", GREY, Shape::Dots, [(1.0, 2.0)]);
        assert!(
            Plot { title: "", axes: ["", ""], layers: vec![dot] }.svg().unwrap().contains("circle")
        );
    }
}
