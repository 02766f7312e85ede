//! A surface: a cell for each point, with its value as colour and in figures.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use tofsim_studies::plan::file::Plot;
use tofsim_studies::table::{Cell, Field, Row};

use crate::text::svg::{chart, picture};

use super::axes::{place, tick};

/// Most cells along a side that have their value written in.
const WRITTEN: usize = 16;
/// Colour of a point without a value.
const MISSING: RGBColor = RGBColor(225, 225, 225);

/// A cell: its place across and up, and its value if there is one.
type SurfaceCell = (f64, f64, Option<f64>);

/// The picture; an error if no row has a value.
pub fn svg(plot: &Plot, fields: &[Field], rows: &[Row]) -> Result<String, String> {
    let names = [Some(&plot.x), plot.y.first(), plot.y.get(1)];
    let [Some(across), Some(up), Some(colour)] = names.map(|name| place(fields, name?)) else {
        return Err("a surface has a column across, one up and one as its colour".to_owned());
    };
    let number = |row: &Row, place: usize| row.cells.get(place).and_then(Cell::as_number);
    let (xs, ys) = (sorted(rows, across), sorted(rows, up));
    let cell = |row: &Row| -> Option<SurfaceCell> {
        let (x, y) = (number(row, across)?, number(row, up)?);
        let at = |all: &[f64], value| all.iter().position(|other| *other == value);
        Some((at(&xs, x)? as f64, at(&ys, y)? as f64, number(row, colour)))
    };
    let cells: Vec<_> = rows.iter().filter_map(cell).collect();
    let values = || cells.iter().filter_map(|(.., value)| *value);
    let ends = [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)];
    if values().next().is_none() {
        return Err("no point has what the plot shows".to_owned());
    }
    picture(|canvas| {
        let title = format!("{} (colour: {})", plot.title, plot.y[1]);
        let mut chart =
            chart(canvas, &title).build_cartesian_2d(0.0..xs.len() as f64, 0.0..ys.len() as f64)?;
        chart.configure_mesh().disable_mesh().disable_axes().draw()?;
        chart.draw_series(cells.iter().map(|(x, y, value)| {
            let shade = value.map_or(MISSING, |value| colour_of(value, ends));
            Rectangle::new([(*x, *y), (x + 1.0, y + 1.0)], shade.filled())
        }))?;
        if xs.len().max(ys.len()) <= WRITTEN {
            chart.draw_series(cells.iter().map(|(x, y, value)| {
                let is_dark = value.is_some_and(|value| part(value, ends) > 0.6);
                let style = text(14, if is_dark { &WHITE } else { &BLACK });
                let style = style.pos(Pos::new(HPos::Center, VPos::Center));
                Text::new(value.map_or("none".to_owned(), tick), (x + 0.5, y + 0.5), style)
            }))?;
        }
        let area = chart.plotting_area();
        let pixel = |x: f64, y: f64| area.map_coordinate(&(x, y));
        let (left, bottom) = pixel(0.0, 0.0);
        let (right, top) = pixel(xs.len() as f64, ys.len() as f64);
        let below = Pos::new(HPos::Center, VPos::Top);
        for (k, value) in (0..).zip(&xs) {
            let (x, _) = pixel(f64::from(k) + 0.5, 0.0);
            canvas.draw(&Text::new(tick(*value), (x, bottom + 6), text(13, &BLACK).pos(below)))?;
        }
        for (k, value) in (0..).zip(&ys) {
            let (_, y) = pixel(0.0, f64::from(k) + 0.5);
            let beside = text(13, &BLACK).pos(Pos::new(HPos::Right, VPos::Center));
            canvas.draw(&Text::new(tick(*value), (left - 6, y), beside))?;
        }
        let label = plot.x_label.clone().unwrap_or(plot.x.clone());
        let middle = ((left + right) / 2, bottom + 24);
        canvas.draw(&Text::new(label, middle, text(13, &BLACK).pos(below)))?;
        let label = plot.y_label.clone().unwrap_or(plot.y[0].clone());
        let turned = text(13, &BLACK).transform(FontTransform::Rotate270).pos(below);
        canvas.draw(&Text::new(label, (14, (bottom + top) / 2), turned))
    })
    .map_err(|fault| fault.to_string())
}

fn text<'a>(size: i32, colour: &'a RGBColor) -> TextStyle<'a> {
    ("sans-serif", size).into_font().color(colour)
}

/// The values of a column, in rising order.
fn sorted(rows: &[Row], place: usize) -> Vec<f64> {
    let mut values: Vec<_> =
        rows.iter().filter_map(|row| row.cells.get(place)?.as_number()).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Returns the position of a value between the least and the largest, on a logarithmic scale where all are above 0.
fn part(value: f64, [low, high]: [f64; 2]) -> f64 {
    if low >= high {
        return 0.0;
    }
    if low > 0.0 { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
}

/// Returns a colour from light yellow over green to dark blue.
fn colour_of(value: f64, ends: [f64; 2]) -> RGBColor {
    const STOPS: [[f64; 3]; 4] =
        [[255.0, 247.0, 188.0], [161.0, 218.0, 180.0], [65.0, 140.0, 185.0], [30.0, 45.0, 110.0]];
    let place = part(value, ends).clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    let [r, g, b] = [0, 1, 2].map(|k| {
        (STOPS[below][k] + (place - below as f64) * (STOPS[below + 1][k] - STOPS[below][k])) as u8
    });
    RGBColor(r, g, b)
}
