//! A TDC's bins, linearity, transfer and precision as pictures.

use std::ops::Range;

use plotters::prelude::*;

use tofsim::error::Result;
use tofsim::scenario::Tdc;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::characterisation::density::CodeDensity;

use crate::text::svg::{chart, legend, picture};

use super::sheet::NamedText;

pub(super) const BLUE: RGBColor = RGBColor(43, 108, 176);

/// A line of a picture: its name, its colour, its points.
pub(super) type PlotLine = (String, RGBColor, Vec<(f64, f64)>);

/// Name and SVG text of each picture.
///
/// # Errors
/// When the plotting library fails.
pub fn all(found: &Characterisation, tdc: &Tdc) -> Result<Vec<NamedText>> {
    let density = &found.density;
    let title =
        |what: &str| format!("{what}, chain {}, calibration {}", tdc.profile, tdc.calibration);
    let by_n = |values: &[f64]| -> Vec<(f64, f64)> {
        density.bins.iter().map(|bin| bin.n as f64).zip(values.iter().copied()).collect()
    };
    let [by_hits, exact] = [density.measured_ps(), density.true_ps()];
    let [dnl, true_dnl] = [&by_hits, &exact].map(|widths| density.dnl(widths));
    let [inl, true_inl] = [&dnl, &true_dnl].map(|dnl| density.inl(dnl));
    let both = |values: &[f64], exact: &[f64]| -> [PlotLine; 2] {
        let hits = format!("by {} hits", density.hits);
        [(hits, BLUE, by_n(values)), ("by the delays".to_owned(), RED, by_n(exact))]
    };
    let equivalent = CodeDensity::equivalent_ps(&exact);
    let widths = format!("Bin widths (equivalent bin {equivalent:.2} ps)");
    let of_points = |value: fn(f64, f64) -> f64| {
        let points = &found.transfer.points;
        let own = points.iter().map(|at| (at.delay_ps * 1e-3, value(at.delay_ps, at.time_ps)));
        let raw = points.iter().map(|at| (at.delay_ps * 1e-3, value(at.delay_ps, at.raw_time_ps)));
        [
            ("uncalibrated".to_owned(), RED, raw.collect()),
            ("the converter's own ROM".to_owned(), BLUE, own.collect()),
        ]
    };
    let stretches = &found.transfer.stretches;
    let precision: [PlotLine; 2] = [
        (
            "uncalibrated".to_owned(),
            RED,
            stretches.iter().map(|at| (at.delay_ps * 1e-3, at.raw_rms_ps)).collect(),
        ),
        (
            "the converter's own ROM".to_owned(),
            BLUE,
            stretches.iter().map(|at| (at.delay_ps * 1e-3, at.rms_ps)).collect(),
        ),
    ];
    let ones = "number by the decoder, n";
    let delay = "delay [ns]";
    let pictures = [
        ("widths.svg", widths.as_str(), [ones, "width [ps]"], both(&by_hits, &exact)),
        ("dnl.svg", "DNL", [ones, "DNL [LSB]"], both(&dnl, &true_dnl)),
        ("inl.svg", "INL", [ones, "INL [LSB]"], both(&inl, &true_inl)),
        (
            "transfer.svg",
            "Error of the time",
            [delay, "time less delay [ps]"],
            of_points(|delay, time| time - delay),
        ),
        ("precision.svg", "Precision", [delay, "rms error [ps]"], precision),
    ];
    let drawn = |(name, what, axes, points): (&str, &str, [&str; 2], [PlotLine; 2])| {
        Ok((name.to_owned(), lines(&title(what), axes, &points)?))
    };
    pictures.into_iter().map(drawn).collect()
}

/// Returns the range from the least to the largest value, and a little beyond.
fn range(values: impl Iterator<Item = f64> + Clone, beyond: f64) -> Range<f64> {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
    let more = (beyond * (largest - least)).max(1e-6);
    least - more..largest + more
}

pub(super) fn lines(title: &str, axes: [&str; 2], lines: &[PlotLine]) -> Result<String> {
    let points = lines.iter().flat_map(|(_, _, points)| points);
    let x = range(points.clone().map(|point| point.0), 0.0);
    let y = range(points.map(|point| point.1), 0.12);
    picture(|canvas| {
        let mut chart = chart(canvas, title).build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(axes[0])
            .y_desc(axes[1])
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        for (name, colour, points) in lines {
            let style = colour.mix(0.75).stroke_width(1);
            chart
                .draw_series(LineSeries::new(points.iter().copied(), style))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], style));
        }
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}
