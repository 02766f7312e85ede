//! Pictures of a characterisation: count rates, intervals, autocorrelation.

use plotters::prelude::*;

use tofsim::error::Result;
use tofsim::sim::free_running::afterpulses::Afterpulses;
use tofsim::sim::free_running::rates::Point;

use crate::report::sheet::NamedText;
use crate::text::svg::{COLOURS, chart, legend, picture};

/// Points of a line.
const POINTS: usize = 200;
/// Points and bars.
const GREY: f64 = 0.6;

/// Draws the pictures.
///
/// # Errors
/// When the plotting library fails.
pub fn svg(
    dead_time_ns: f64,
    points: &[Point],
    afterpulses: Option<&Afterpulses>,
) -> Result<Vec<NamedText>> {
    let mut all = vec![("rates.svg".to_owned(), rates(dead_time_ns, points)?)];
    if let Some(seen) = afterpulses {
        all.push(("intervals.svg".to_owned(), intervals(seen)?));
        all.push(("autocorrelation.svg".to_owned(), autocorrelation(seen)?));
    }
    Ok(all)
}

fn rates(dead_time_ns: f64, points: &[Point]) -> Result<String> {
    let incident = |k: usize| points[k].incident_hz;
    let (first, last) = (incident(0), incident(points.len() - 1));
    let dead_s = dead_time_ns * 1e-9;
    let title = format!("Count rate, dead time {} ns", dead_time_ns);
    let form = |kind: usize, part: f64| if kind == 0 { 1.0 / (1.0 + part) } else { (-part).exp() };
    picture(|canvas| {
        let x = (first / 1.3..last * 1.3).log_scale();
        let y = (first / 2.0..4.0 / dead_s).log_scale();
        let mut chart = chart(canvas, &title).build_cartesian_2d(x, y)?;
        let power = |hz: &f64| format!("{hz:.0e}");
        let mut mesh = chart.configure_mesh();
        mesh.x_desc("incident rate [1/s]").y_desc("count rate [1/s]");
        mesh.x_label_formatter(&power).y_label_formatter(&power);
        mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
        for (kind, name) in ["n / (1 + n tau)", "n exp(-n tau)"].into_iter().enumerate() {
            let colour = COLOURS[kind];
            let at = |k: usize| first * (last / first).powf(k as f64 / POINTS as f64);
            let line = (0..=POINTS).map(|k| (at(k), at(k) * form(kind, at(k) * dead_s)));
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
            let dots = points.iter();
            let dots = dots.map(|point| (point.incident_hz, point.counted_hz[kind].value));
            let dots = dots.filter(|dot| dot.1 > 0.0);
            chart.draw_series(dots.map(|dot| Circle::new(dot, 4, colour.filled())))?;
        }
        let own = points.iter().filter_map(|p| Some((p.incident_hz, p.own_hz?.value)));
        let own: Vec<_> = own.filter(|dot| dot.1 > 0.0).collect();
        if !own.is_empty() {
            let style = BLACK.mix(GREY).stroke_width(2);
            chart
                .draw_series(own.into_iter().map(|dot| Circle::new(dot, 6, style)))?
                .label("with afterpulses")
                .legend(move |(x, y)| Circle::new((x + 9, y), 5, style));
        }
        legend(&mut chart, SeriesLabelPosition::UpperLeft)
    })
}

fn intervals(seen: &Afterpulses) -> Result<String> {
    let ends = &seen.interval_ends_s;
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let most = seen.intervals.iter().max().copied().unwrap_or(0).max(10) as f64;
    let all = seen.intervals.iter().sum::<u64>() as f64;
    // The light's own intervals: those of the tail, and as many as go before it by the same law.
    let tail_hz = seen.tail_hz;
    let light = |ends: &[f64]| {
        let none_until = |s: f64| (-tail_hz.value * (s - first)).exp();
        all * (1.0 - seen.after_dead_time.value) * (none_until(ends[0]) - none_until(ends[1]))
    };
    picture(|canvas| {
        let (x, y) = ((first..last).log_scale(), (0.5..2.0 * most).log_scale());
        let mut chart = chart(canvas, "Intervals between counts").build_cartesian_2d(x, y)?;
        let power = |s: &f64| format!("{s:.0e}");
        let mut mesh = chart.configure_mesh();
        mesh.x_desc("interval [s]").y_desc("intervals in a bin").x_label_formatter(&power);
        mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
        let bars = ends.windows(2).zip(&seen.intervals).filter(|(_, count)| **count > 0);
        let bars = bars.map(|(ends, count)| {
            Rectangle::new([(ends[0], 0.5), (ends[1], *count as f64)], COLOURS[0].mix(0.5).filled())
        });
        chart
            .draw_series(bars)?
            .label("measured")
            .legend(|(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], COLOURS[0].filled()));
        let line = ends.windows(2).map(|ends| ((ends[0] * ends[1]).sqrt(), light(ends)));
        let line: Vec<_> = line.filter(|point| point.1 > 0.5).collect();
        chart
            .draw_series(LineSeries::new(line, BLACK.stroke_width(2)))?
            .label(format!("light and dark alone, {:.4e} 1/s by the tail", tail_hz.value))
            .legend(|(x, y)| PathElement::new([(x, y), (x + 12, y)], BLACK));
        legend(&mut chart, SeriesLabelPosition::UpperLeft)
    })
}

fn autocorrelation(seen: &Afterpulses) -> Result<String> {
    let bin_ns = 1e9 * seen.window_s / seen.pairs.len() as f64;
    let most = seen.pairs.iter().max().copied().unwrap_or(0) as f64;
    let top = 1.2 * most.max(2.0 * seen.chance_pairs).max(1.0);
    let title = format!(
        "Autocorrelation: {:.5} +- {:.5} afterpulses after the dead time",
        seen.after_dead_time.value, seen.after_dead_time.se
    );
    picture(|canvas| {
        let x = 0.0..bin_ns * seen.pairs.len() as f64;
        let mut chart = chart(canvas, &title).build_cartesian_2d(x.clone(), 0.0..top)?;
        let mut mesh = chart.configure_mesh();
        mesh.x_desc("distance of two counts [ns]").y_desc("pairs in a bin");
        mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.08)).draw()?;
        let bars = seen.pairs.iter().enumerate().map(|(k, pairs)| {
            let from = k as f64 * bin_ns;
            let corners = [(from, 0.0), (from + bin_ns, *pairs as f64)];
            Rectangle::new(corners, COLOURS[0].mix(0.5).filled())
        });
        chart
            .draw_series(bars)?
            .label("measured")
            .legend(|(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], COLOURS[0].filled()));
        let chance = [(x.start, seen.chance_pairs), (x.end, seen.chance_pairs)];
        chart
            .draw_series(LineSeries::new(chance, BLACK.stroke_width(2)))?
            .label("by chance")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 12, y)], BLACK));
        let expected = seen.expected_pairs.iter().enumerate();
        let expected = expected.map(|(k, pairs)| ((k as f64 + 0.5) * bin_ns, *pairs));
        chart
            .draw_series(LineSeries::new(expected, COLOURS[1].stroke_width(2)))?
            .label("as the keys have it")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 12, y)], COLOURS[1]));
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}
