//! Pictures as SVG text.

use std::io;

use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::*;

use tofsim::error::{Input, Result};

/// Width and height of a picture [px].
const SIZE: (u32, u32) = (1000, 520);

/// A colour for each estimator; more of them begin again.
pub const COLOURS: [RGBColor; 6] = [
    RGBColor(43, 108, 176),
    RGBColor(221, 107, 32),
    RGBColor(47, 133, 90),
    RGBColor(128, 90, 213),
    RGBColor(151, 90, 22),
    RGBColor(74, 85, 104),
];

/// Longest title that is drawn at full size [characters].
const TITLE: usize = 72;

/// Outcome of drawing; an error only if the plotting library fails.
pub type Drawn = std::result::Result<(), DrawingAreaErrorKind<io::Error>>;

/// Drawing area of a picture.
pub type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A chart with words above it and room for its axes.
pub fn chart<'a, 'b, 'c>(
    canvas: &'a Canvas<'b>,
    title: &str,
) -> ChartBuilder<'a, 'c, SVGBackend<'b>> {
    let mut chart = ChartBuilder::on(canvas);
    // As wide as the picture at most, and room for the half of the last number that stands beyond the axis.
    let size = 18 * TITLE / title.chars().count().max(TITLE);
    chart.margin(12).margin_right(24).caption(title, ("sans-serif", size as u32));
    chart.x_label_area_size(42).y_label_area_size(64);
    chart
}

/// Draws the legend of a chart in one of its corners; an error only if the plotting
/// library fails.
pub fn legend<'a, 'b: 'a, C: CoordTranslate>(
    chart: &mut ChartContext<'a, SVGBackend<'b>, C>,
    corner: SeriesLabelPosition,
) -> Drawn {
    let mut labels = chart.configure_series_labels();
    labels.position(corner).label_font(("sans-serif", 14));
    labels.background_style(WHITE.mix(0.85)).border_style(BLACK.mix(0.2)).draw()
}

/// Returns what `draw` draws on white as SVG text.
///
/// # Errors
/// When the plotting library fails.
pub fn picture(draw: impl FnOnce(&Canvas) -> Drawn) -> Result<String> {
    picture_of(SIZE, draw)
}

/// Returns a picture of that width and height as SVG text [px].
///
/// # Errors
/// When the plotting library fails.
pub fn picture_of(size: (u32, u32), draw: impl FnOnce(&Canvas) -> Drawn) -> Result<String> {
    let mut text = String::new();
    let canvas = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let drawn = canvas.fill(&WHITE).and_then(|()| draw(&canvas)).and_then(|()| canvas.present());
    drawn.map_err(|fault| Input::new("picture", fault))?;
    drop(canvas);
    Ok(text)
}
