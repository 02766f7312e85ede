//! An error budget as stacked bars: what each effect alone adds to the bias, and to the variance beside shot noise,
//! with a line where all together are.

use plotters::prelude::*;

use tofsim::error::Result;
use tofsim_learn::error_budget::DepthBudget;
use tofsim_learn::error_budget::effect::Effect;
use tofsim_learn::error_budget::figures::ErrorChange;

use crate::text::svg::{COLOURS, Canvas, Drawn, chart, picture};

use super::files::DepthBudgets;

/// Width of the bars, where their places are 1 apart.
const BAR: f64 = 0.6;
/// Height of the upper chart [px].
const UPPER: u32 = 260;
/// Width of the charts, left of the legend [px].
const CHARTS: u32 = 830;

/// A part of a bar.
struct BarPart {
    name: &'static str,
    colour: RGBColor,
    /// Height at each point; 0 where the effect is off.
    heights: Vec<f64>,
}

/// The picture; an error only if the plotting library fails.
pub fn svg(of: &DepthBudgets) -> Result<String> {
    let variance = |budget: &DepthBudget| budget.together.variance_mm2().unwrap_or(0.0);
    let bias = |budget: &DepthBudget| budget.together.mean_mm.unwrap_or(0.0);
    let biases = parts(of, |change| change.mean_mm, |budget| budget.none.mean_mm.unwrap_or(0.0));
    let variances = parts(of, |change| change.variance_mm2, |_| 0.0);
    let kind = of.points.first().map_or("", |(_, budget)| budget.kind.name());
    let title = format!("error budget of {kind}: what each effect alone adds");
    picture(|canvas| {
        let (charts, side) = canvas.split_horizontally(CHARTS);
        let (upper, lower) = charts.split_vertically(UPPER);
        bars(&upper, of, &title, "bias [mm]", &biases, bias)?;
        bars(&lower, of, "", "variance [mm^2]", &variances, variance)?;
        legend(&side, &biases, &variances)
    })
}

/// The parts of all bars: the estimator's own, and those of all effects that are on somewhere.
fn parts(
    of: &DepthBudgets,
    change: fn(&ErrorChange) -> Option<f64>,
    own: fn(&DepthBudget) -> f64,
) -> Vec<BarPart> {
    let heights = |height: &dyn Fn(&DepthBudget) -> f64| -> Vec<f64> {
        of.points.iter().map(|(_, budget)| height(budget)).collect()
    };
    let grey = RGBColor(160, 160, 160);
    let first = BarPart { name: "estimator's own", colour: grey, heights: heights(&own) };
    let of_effect = |(place, effect): (usize, Effect)| {
        let adds = |budget: &DepthBudget| {
            let row = budget.effects.iter().find(|row| row.effect == effect);
            row.and_then(|row| change(row.adds.as_ref()?)).unwrap_or(0.0)
        };
        BarPart { name: effect.name(), colour: colour(place), heights: heights(&adds) }
    };
    let is_on = |effect: &Effect| {
        let mut rows = of.points.iter().flat_map(|(_, budget)| &budget.effects);
        rows.any(|row| row.effect == *effect && row.adds.is_some())
    };
    let effects = Effect::ALL.into_iter().filter(is_on).enumerate();
    [first].into_iter().chain(effects.map(of_effect)).collect()
}

/// A colour for each effect: the six, and then lighter ones.
fn colour(place: usize) -> RGBColor {
    let RGBColor(red, green, blue) = COLOURS[place % COLOURS.len()];
    let lighter = |part: u8| match place / COLOURS.len() {
        0 => part,
        round => 255 - ((255 - u32::from(part)) / (round as u32 + 1)) as u8,
    };
    RGBColor(lighter(red), lighter(green), lighter(blue))
}

/// A chart of stacked bars, what is above zero upwards and what is below downwards, and a line for all together.
fn bars(
    canvas: &Canvas,
    of: &DepthBudgets,
    title: &str,
    quantity: &str,
    parts: &[BarPart],
    together: fn(&DepthBudget) -> f64,
) -> Drawn {
    let stacks: Vec<_> = (0..of.points.len()).map(|point| stack(parts, point)).collect();
    let totals = of.points.iter().map(|(_, budget)| together(budget));
    let ends = stacks.iter().flatten().flat_map(|(_, from, until)| [*from, *until]).chain(totals);
    let (low, high) = ends.fold((0.0, 0.0), |(a, b), end| (f64::min(a, end), f64::max(b, end)));
    let room = ((high - low) * 0.08).max(1e-6);
    let low = if low < 0.0 { low - room } else { 0.0 };
    let mut chart = chart(canvas, title);
    let mut chart =
        chart.build_cartesian_2d(-0.6..of.points.len() as f64 - 0.4, low..high + room)?;
    let value = |place: &f64| match of.points.get(place.round().max(0.0) as usize) {
        Some((value, _)) if place.fract() == 0.0 && *place >= 0.0 => value.to_string(),
        _ => String::new(),
    };
    let number = |mm: &f64| format!("{}", (1e6 * mm).round() / 1e6);
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(of.key.unwrap_or("target.distance_m")).y_desc(quantity);
    mesh.x_labels(of.points.len().min(20) * 2 + 1).x_label_formatter(&value);
    mesh.y_labels(7).y_label_formatter(&number).label_style(("sans-serif", 13));
    mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
    for (point, stack) in stacks.iter().enumerate() {
        let (left, right) = (point as f64 - BAR / 2.0, point as f64 + BAR / 2.0);
        let bars = stack.iter().map(|&(colour, from, until)| {
            Rectangle::new([(left, from), (right, until)], colour.filled())
        });
        chart.draw_series(bars)?;
        let total = together(&of.points[point].1);
        let ends = vec![(left - 0.1, total), (right + 0.1, total)];
        chart.draw_series([PathElement::new(ends, BLACK.stroke_width(2))])?;
    }
    let zero = vec![(-0.6, 0.0), (of.points.len() as f64 - 0.4, 0.0)];
    chart.draw_series([PathElement::new(zero, BLACK.mix(0.5))])?;
    Ok(())
}

/// Colour, begin and end of the parts of a bar.
fn stack(parts: &[BarPart], point: usize) -> Vec<(RGBColor, f64, f64)> {
    let (mut above, mut below) = (0.0, 0.0);
    let part = |part: &BarPart| {
        let height = part.heights[point];
        let end = if height < 0.0 { &mut below } else { &mut above };
        let from = *end;
        *end += height;
        (part.colour, from, *end)
    };
    parts.iter().map(part).collect()
}

/// Draws the legend.
fn legend(side: &Canvas, biases: &[BarPart], variances: &[BarPart]) -> Drawn {
    let style = ("sans-serif", 14).into_font();
    let shown = biases.iter().zip(variances);
    let shown = shown.filter(|(bias, variance)| {
        bias.heights.iter().chain(&variance.heights).any(|height| *height != 0.0)
    });
    let mut y = 50;
    for (part, _) in shown {
        side.draw(&Rectangle::new([(6, y), (18, y + 12)], part.colour.filled()))?;
        side.draw(&Text::new(part.name, (26, y - 1), style.clone()))?;
        y += 22;
    }
    side.draw(&PathElement::new(vec![(4, y + 6), (20, y + 6)], BLACK.stroke_width(2)))?;
    side.draw(&Text::new("all together", (26, y - 1), style))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_stacked_on_their_own_side_of_zero() {
        let part = |height: f64| BarPart { name: "", colour: BLACK, heights: vec![height] };
        let parts = [1.0, -2.0, 3.0, -0.5].map(part);
        let ends: Vec<_> = stack(&parts, 0).iter().map(|&(_, from, until)| (from, until)).collect();
        assert_eq!(ends, [(0.0, 1.0), (0.0, -2.0), (1.0, 4.0), (-2.0, -2.5)]);
    }

    #[test]
    fn colours_differ() {
        let all: Vec<_> = (0..15).map(colour).collect();
        assert!((1..15).all(|k| !all[..k].contains(&all[k])));
    }
}
