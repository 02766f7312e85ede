//! The boxes with what lies beyond them and the limits beside, and the strip below: which part of the histograms has no
//! estimate, or one far off.

use plotters::prelude::*;

use tofsim_learn::evaluation::{Group, Spread};

use crate::text::svg::{Canvas, Drawn, legend};

use super::{BoxPlot, Chart, Limit};

type BoxPoint = (f64, f64);

/// Ink of a box.
const BOX: f64 = 0.35;

/// Errors beyond the whiskers are shown up to so many times the farthest whisker, and at the edge from there on.
const SHOWN: f64 = 2.5;

impl BoxPlot<'_> {
    /// Largest error on the scale [mm].
    fn highest(&self) -> f64 {
        let spreads = || self.series.iter().flat_map(|one| one.groups).map(|group| &group.spread);
        let whiskers = spreads().filter_map(|spread| Some(spread.tails.as_ref()?.whiskers_mm));
        let reach = whiskers.flatten().map(f64::abs).fold(0.1, f64::max);
        let beyond =
            spreads().filter_map(|spread| spread.tails.as_ref()).flat_map(|t| &t.beyond_mm);
        let beyond = beyond.map(|error| error.abs()).fold(0.0, f64::max).min(SHOWN * reach);
        let values = self.values();
        let least =
            |limit: &Limit| values.iter().map(|&value| (limit.mm)(value)).fold(f64::NAN, f64::min);
        let limits = self.limits.iter().map(least).fold(0.0, f64::max);
        1.1 * reach.max(beyond).max(limits)
    }

    /// Draws them on a scale of their own.
    pub(super) fn boxes(&self, canvas: &Canvas) -> Drawn {
        let highest = self.highest();
        let words = [self.quantity, "error of the depth [mm]"];
        let labels = if self.series.len() > 1 { self.series.len() } else { 0 } + self.limits.len();
        let room = highest * (1.0 + 0.12 * labels as f64);
        let mut chart = self.axes(canvas, self.title, -highest..room, words)?;
        self.draw_limits(&mut chart, highest)?;
        for (series, colour, centre, width) in self.beside() {
            let places =
                || series.groups.iter().enumerate().map(|(k, one)| (k as f64 + centre, one));
            let boxes = places().filter_map(|(at, one)| boxed(&one.spread, at, width, colour));
            let (filled, lines): (Vec<_>, Vec<_>) = boxes.unzip();
            let drawn = chart.draw_series(filled)?;
            if self.series.len() > 1 {
                drawn.label(series.name).legend(move |(x, y)| {
                    Rectangle::new([(x, y - 5), (x + 12, y + 5)], colour.mix(BOX).filled())
                });
            }
            chart.draw_series(lines.into_iter().flatten())?;
            let beyond = |spread: &Spread| spread.tails.clone().map(|tails| tails.beyond_mm);
            let dots = places().flat_map(|(at, one)| {
                let beyond = beyond(&one.spread).unwrap_or_default();
                beyond.into_iter().map(move |error| (at, error))
            });
            let (on, off): (Vec<_>, Vec<_>) = dots.partition(|(_, error)| error.abs() <= highest);
            let style = colour.mix(0.6);
            chart.draw_series(on.into_iter().map(|dot| Circle::new(dot, 1, style.filled())))?;
            let edge = off.into_iter().map(|(at, error)| (at, 0.99 * highest.copysign(error)));
            chart.draw_series(edge.map(|dot| TriangleMarker::new(dot, 4, style.filled())))?;
        }
        match labels {
            0 => Ok(()),
            _ => legend(&mut chart, SeriesLabelPosition::UpperLeft),
        }
    }

    fn draw_limits(&self, chart: &mut Chart, highest: f64) -> Drawn {
        for limit in self.limits {
            let style = limit.colour.mix(0.7).stroke_width(2);
            for (k, sign) in [-1.0, 1.0].into_iter().enumerate() {
                let heights = self.values().into_iter().map(|value| (limit.mm)(value));
                let line = heights.enumerate().filter(|(_, mm)| *mm <= highest);
                let line = line.map(|(place, mm)| (place as f64, sign * mm));
                let drawn = chart.draw_series(LineSeries::new(line, style))?;
                if k == 0 {
                    drawn
                        .label(limit.name)
                        .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], style));
                }
            }
        }
        Ok(())
    }
}

/// Box, and whiskers and median, of errors at a place; none without errors.
fn boxed(
    spread: &Spread,
    at: f64,
    width: f64,
    colour: RGBColor,
) -> Option<(Rectangle<BoxPoint>, [PathElement<BoxPoint>; 3])> {
    let [_, lower, median, upper, _] = spread.quartiles_mm?;
    let [low, high] = spread.tails.as_ref()?.whiskers_mm;
    let [left, right] = [at - width / 2.0, at + width / 2.0];
    let line = |from, to| PathElement::new(vec![from, to], colour);
    Some((
        Rectangle::new([(left, lower), (right, upper)], colour.mix(BOX).filled()),
        [
            line((at, low), (at, lower)),
            line((at, upper), (at, high)),
            line((left, median), (right, median)),
        ],
    ))
}

impl BoxPlot<'_> {
    /// Whether there are any.
    pub(super) fn has_missing(&self) -> bool {
        let mut groups = self.series.iter().flat_map(|one| one.groups);
        groups.any(|Group { spread, .. }| spread.failures + spread.outliers > 0)
    }

    /// The parts without an estimate, and above them those far off.
    pub(super) fn missing(&self, canvas: &Canvas) -> Drawn {
        let part = |spread: &Spread, count: u64| {
            100.0 * count as f64 / (spread.estimates + spread.failures).max(1) as f64
        };
        let all = |spread: &Spread| part(spread, spread.failures + spread.outliers);
        let groups = self.series.iter().flat_map(|one| one.groups);
        let most = groups.map(|group| all(&group.spread)).fold(0.0, f64::max);
        let mut chart =
            self.axes(canvas, "", 0.0..1.1 * most, ["none (full) or far off (pale)", "% of all"])?;
        for (series, colour, centre, width) in self.beside() {
            let bar = |(place, group): (usize, &Group)| {
                let spread = &group.spread;
                let [left, right] = [-0.5, 0.5].map(|side| place as f64 + centre + side * width);
                let failed = part(spread, spread.failures);
                [(0.0, failed, 0.9), (failed, all(spread), 0.35)].map(|(from, to, ink)| {
                    Rectangle::new([(left, from), (right, to)], colour.mix(ink).filled())
                })
            };
            let bars =
                series.groups.iter().enumerate().filter(|(_, group)| all(&group.spread) > 0.0);
            chart.draw_series(bars.flat_map(bar))?;
        }
        Ok(())
    }
}
