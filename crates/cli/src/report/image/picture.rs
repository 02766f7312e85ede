//! The first image as pictures: depth and sigma in colour, and depths in grey, in whole millimetres.

use plotters::prelude::*;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};
use plotters::style::text_anchor::{HPos, Pos, VPos};

use tofsim::error::{Input, Result};

use crate::report::sheet::NamedBytes;
use crate::text::svg::{Canvas, Drawn, picture_of};

use super::readings::{DepthImages, Reading};

/// Longest side of a panel [px].
const PANEL: usize = 480;
/// Space above a panel, for words, and around it [px].
const ABOVE: usize = 64;
const MARGIN: usize = 40;
/// Width of a scale, and the space that it takes with its numbers [px].
const SCALE: i32 = 14;
const SCALE_AND_WORDS: usize = 96;
/// Colour of an invalid pixel.
const INVALID: RGBColor = RGBColor(225, 225, 225);
/// Part of the pixels beyond each end of a scale [1].
const BEYOND: f64 = 0.01;
/// Numbers beside a scale.
const TICKS: usize = 5;

/// A panel: its title, the unit and the value of each pixel.
type Panel = (String, Vec<Option<f64>>);

/// Returns depth and, where the estimator states it, sigma as SVG text.
///
/// # Errors
/// When the plotting library fails.
pub fn svg(images: &DepthImages) -> Result<String> {
    let setup = images.array.common();
    let of_depth =
        format!("depth along the line of sight [m], {}", setup.params.estimator.estimator());
    let mut panels: Vec<Panel> = vec![(of_depth, images.first(|one| one.radial_m()))];
    if setup.params.estimator.states_sigma() {
        let sigma_mm = |one: &Reading| one.sigma_m().map(|sigma_m| 1e3 * sigma_m);
        panels.push(("sigma [mm]".to_owned(), images.first(sigma_mm)));
    }
    let [rows, columns] = images.array.size();
    let cell = (PANEL / rows.max(columns)).max(1);
    let [width, height] = [columns * cell, rows * cell];
    let panel_width = (width + SCALE_AND_WORDS).max(PANEL) + MARGIN;
    let size = [MARGIN + panels.len() * panel_width, ABOVE + height + MARGIN];
    picture_of((size[0] as u32, size[1] as u32), |canvas| {
        let title =
            format!("{}, {rows} x {columns} pixels, seed {}", setup.name, setup.scenario.seed);
        canvas.draw(&Text::new(title, (MARGIN as i32, 12), ("sans-serif", 18).into_font()))?;
        for (k, panel) in panels.iter().enumerate() {
            let left = (MARGIN + k * panel_width) as i32;
            draw(canvas, panel, [left, ABOVE as i32], [rows, columns], cell as i32)?;
        }
        Ok(())
    })
}

/// Draws a panel with its top left corner at a place.
fn draw(
    canvas: &Canvas,
    (title, values): &Panel,
    [left, top]: [i32; 2],
    [rows, columns]: [usize; 2],
    cell: i32,
) -> Drawn {
    let style = ("sans-serif", 14).into_font();
    canvas.draw(&Text::new(title.clone(), (left, top - 22), style.clone()))?;
    let ends = ends(values);
    for (place, value) in values.iter().enumerate() {
        let colour = match (value, ends) {
            (Some(value), Some(ends)) => colour(*value, ends),
            _ => INVALID,
        };
        let (x, y) =
            (left + (place % columns) as i32 * cell, top + (place / columns) as i32 * cell);
        canvas.draw(&Rectangle::new([(x, y), (x + cell, y + cell)], colour.filled()))?;
    }
    let corner = |x: usize, y: usize| (left + x as i32 * cell, top + y as i32 * cell);
    canvas.draw(&Rectangle::new([corner(0, 0), corner(columns, rows)], BLACK.mix(0.4)))?;
    let words = style.color(&BLACK);
    let beside = words.pos(Pos::new(HPos::Left, VPos::Center));
    let (x, bottom) = (left + columns as i32 * cell + 16, top + rows as i32 * cell);
    if values.iter().any(Option::is_none) {
        let place = (left, bottom + 10);
        canvas.draw(&Rectangle::new([place, (left + 12, bottom + 22)], INVALID.filled()))?;
        canvas.draw(&Text::new("invalid", (left + 18, bottom + 16), beside.clone()))?;
    }
    let Some(ends) = ends else { return Ok(()) };
    let height = bottom - top;
    for y in 0..height {
        let part = 1.0 - f64::from(y) / f64::from(height);
        let colour = colour(ends[0] + part * (ends[1] - ends[0]), ends);
        canvas.draw(&Rectangle::new([(x, top + y), (x + SCALE, top + y + 1)], colour.filled()))?;
    }
    for tick in 0..TICKS {
        let part = tick as f64 / (TICKS - 1) as f64;
        let text = format!("{:.3}", ends[0] + part * (ends[1] - ends[0]));
        let y = bottom - (part * f64::from(height)) as i32;
        canvas.draw(&Text::new(text, (x + SCALE + 6, y), beside.clone()))?;
    }
    Ok(())
}

/// Returns the ends of a scale that holds nearly all of some values.
fn ends(values: &[Option<f64>]) -> Option<[f64; 2]> {
    let mut sorted: Vec<_> = values.iter().copied().flatten().collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let beyond = (BEYOND * sorted.len() as f64) as usize;
    Some([*sorted.get(beyond)?, *sorted.get(sorted.len().checked_sub(1 + beyond)?)?])
}

/// Returns the colour of a value: dark where it is low, light where it is high, so that it is read without colours too.
fn colour(value: f64, [low, high]: [f64; 2]) -> RGBColor {
    let part = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
    ViridisRGB.get_color(part)
}

/// Returns the depths as grey pictures of 16 bits, in millimetres; 0 is invalid.
///
/// # Errors
/// When a picture cannot be encoded.
pub fn pngs(images: &DepthImages, record: &str) -> Result<[NamedBytes; 2]> {
    let size = images.array.size();
    Ok([
        png("depth_radial.png", size, images.first(|one| one.radial_m()), record)?,
        png("depth_perpendicular.png", size, images.first(|one| one.perpendicular_m()), record)?,
    ])
}

fn png(
    name: &str,
    [rows, columns]: [usize; 2],
    depths_m: Vec<Option<f64>>,
    record: &str,
) -> Result<NamedBytes> {
    let grey = |depth_m: &Option<f64>| depth_m.map_or(0, |depth_m| (1e3 * depth_m).round() as u16);
    let data: Vec<u8> = depths_m.iter().flat_map(|depth_m| grey(depth_m).to_be_bytes()).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let text = record.to_owned();
    let encoded = encoder
        .add_itxt_chunk("Comment".to_owned(), text)
        .and_then(|()| encoder.write_header())
        .and_then(|mut writer| writer.write_image_data(&data));
    encoded.map_err(|error| Input::new(name, error))?;
    Ok((name.to_owned(), bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_colours_also_where_all_are_the_same_or_beyond_the_scale() {
        let [dark, middle, light] = [0.0, 0.5, 1.0].map(|part| ViridisRGB.get_color(part));
        assert_eq!(colour(8.0, [8.0, 8.0]), middle);
        assert_eq!([0.1, 0.9].map(|value| colour(value, [0.2, 0.8])), [dark, light]);
        assert_eq!(colour(0.5, [0.0, 1.0]), middle);
        assert_eq!(ends(&[None, Some(3.0), None]), Some([3.0, 3.0]));
        assert_eq!(ends(&[None]), None);
    }
}
