//! Errors by a quantity of the scene, as boxes: one for each value and estimator.

mod boxes;

use std::ops::Range;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use tofsim::error::Result;
use tofsim_learn::evaluation::Group;

use crate::text::svg::{COLOURS, Canvas, chart, picture};

/// Part of the place of a value that its boxes take.
const FILLED: f64 = 0.7;

/// The errors of an estimator by a quantity.
#[derive(Clone, Copy, Debug)]
pub struct Series<'a> {
    /// The estimator's name.
    pub name: &'a str,
    /// Its errors; of all series at the same values.
    pub groups: &'a [Group],
}

/// Limit of the errors, drawn on both sides of zero.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Name in the legend.
    pub name: &'static str,
    /// Its half width at a value [mm].
    pub mm: fn(f64) -> f64,
    /// Colour of its lines.
    pub colour: RGBColor,
}

/// Errors to draw.
#[derive(Clone, Copy, Debug)]
pub struct BoxPlot<'a> {
    /// Title above the plot.
    pub title: &'a str,
    /// Quantity that groups the errors, with its unit.
    pub quantity: &'a str,
    /// Estimators, side by side.
    pub series: &'a [Series<'a>],
    /// Limits to lie beside, as far as they are on the scale of the errors; the least value of each is.
    pub limits: &'a [Limit],
}

type Axes = Cartesian2d<RangedCoordf64, RangedCoordf64>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Axes>;

impl BoxPlot<'_> {
    /// The picture as SVG text; an error only if the plotting library fails. Values have places equally
    /// far apart. Below the boxes are the parts of the histograms without an estimate or with one that is
    /// far off, if there are any.
    pub fn svg(&self) -> Result<String> {
        picture(|canvas| {
            if self.has_missing() {
                let (boxes, missing) = canvas.split_vertically(390);
                self.boxes(&boxes)?;
                self.missing(&missing)
            } else {
                self.boxes(canvas)
            }
        })
    }

    fn values(&self) -> Vec<f64> {
        let groups = self.series.first().map_or(&[][..], |one| one.groups);
        groups.iter().map(|group| group.value).collect()
    }

    /// A chart with a place for each value.
    fn axes<'a, 'b>(
        &self,
        canvas: &'a Canvas<'b>,
        title: &str,
        heights: Range<f64>,
        words: [&str; 2],
    ) -> std::result::Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
        let (values, heights_px) = (self.values(), canvas.dim_in_pixel().1);
        let mut chart = chart(canvas, title)
            .build_cartesian_2d(-0.5..values.len().max(1) as f64 - 0.5, heights)?;
        let value = |place: &f64| match values.get(place.round().max(0.0) as usize) {
            Some(value) if place.fract() == 0.0 => format!("{}", (1e9 * value).round() / 1e9),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .x_desc(words[0])
            .y_desc(words[1])
            .x_labels(values.len().min(14) + 1)
            .x_label_formatter(&value)
            .y_labels((heights_px / 40) as usize)
            .label_style(("sans-serif", 13))
            .axis_desc_style(("sans-serif", 14))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        Ok(chart)
    }

    /// Each series with its place beside a value's, and the width of a box.
    fn beside(&self) -> impl Iterator<Item = (&Series<'_>, RGBColor, f64, f64)> {
        let each = FILLED / self.series.len().max(1) as f64;
        self.series.iter().enumerate().map(move |(k, series)| {
            let centre = (k as f64 + 0.5) * each - FILLED / 2.0;
            (series, COLOURS[k % COLOURS.len()], centre, 0.9 * each)
        })
    }
}

#[cfg(test)]
mod tests {
    use tofsim_learn::evaluation::Spread;

    use super::*;

    fn group(value: f64, errors_mm: &[f64], failures: usize) -> Group {
        let errors = errors_mm.iter().map(|&mm| Some(1e-3 * mm));
        Group { value, spread: Spread::of(errors.chain(vec![None; failures])) }
    }

    fn drawn(series: &[Series], limits: &[Limit]) -> String {
        let plot = BoxPlot { title: "errors", quantity: "distance [m]", series, limits };
        let svg = plot.svg().unwrap();
        assert_eq!(plot.svg().unwrap(), svg);
        svg
    }

    #[test]
    fn estimators_stand_side_by_side_with_what_they_miss() {
        let a = [group(0.1, &[1.0, 2.0], 0), group(0.2, &[], 3), group(0.35, &[-1.0, 0.0], 0)];
        let b = [group(0.1, &[4.0, 5.0], 1), group(0.2, &[3.0], 0), group(0.35, &[0.0], 0)];
        let [a, b] = [("network", &a), ("peak", &b)].map(|(name, groups)| Series { name, groups });
        let one = drawn(&[a], &[]);
        // Background, two boxes, and a bar for the failures.
        assert_eq!(one.matches("<rect").count(), 1 + 2 + 2, "{one}");
        assert!(one.contains("% of all") && !one.contains("network"), "{one}");
        let both = drawn(&[a, b], &[]);
        for words in ["network", "peak", "0.1\n", "0.35\n"] {
            assert!(both.contains(words), "{words}: {both}");
        }
        let none = drawn(&[], &[]);
        assert!(!none.contains("% of all"));
    }

    #[test]
    fn what_lies_beyond_the_whiskers_is_a_dot_or_a_mark_at_the_edge() {
        let errors = [-1.0, -0.5, -0.4, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 1.0, 2.2, 90.0];
        let groups = [group(0.3, &errors, 0)];
        let svg = drawn(&[Series { name: "network", groups: &groups }], &[]);
        assert_eq!((svg.matches("<circle").count(), svg.matches("<polygon").count()), (1, 1));
    }

    #[test]
    fn a_limit_is_drawn_on_both_sides_as_far_as_the_scale_goes() {
        let groups = [group(0.1, &[1.0, -1.0], 0), group(0.2, &[1.0], 0), group(0.6, &[1.0], 0)];
        let limit = Limit { name: "allowed", mm: |m| 100.0 * m, colour: RED };
        let series = [Series { name: "network", groups: &groups }];
        let lines = |svg: &str| svg.matches("#FF0000").count();
        // A line on either side and one in the legend; 60 mm are off the scale.
        assert_eq!(lines(&drawn(&series, &[limit])), 3);
        assert_eq!(lines(&drawn(&series, &[])), 0);
    }
}
