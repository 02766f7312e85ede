//! The histogram's counts by what set the avalanche off, and their picture: stacked by cause over time and depth.

use std::ops::Range;

use plotters::coord::types::{RangedCoordf64, RangedCoordu32};
use plotters::prelude::*;

use tofsim::error::Result;
use tofsim::optics::hazard::Cause;
use tofsim::scenario::Tdc;
use tofsim::sim::shot_recorder::Shot;

use crate::text::svg::{Drawn, chart, legend, picture};

/// Causes in the order in which they are stacked, with words and colours; `None` is unknown.
pub const CAUSES: [(Option<Cause>, &str, RGBColor); 6] = [
    (Some(Cause::Dark), Cause::Dark.word(), RGBColor(80, 80, 80)),
    (Some(Cause::Ambient), Cause::Ambient.word(), RGBColor(236, 180, 84)),
    (Some(Cause::Cover), Cause::Cover.word(), RGBColor(126, 87, 164)),
    (Some(Cause::Signal), Cause::Signal.word(), RGBColor(43, 108, 176)),
    (Some(Cause::Afterpulse), Cause::Afterpulse.word(), RGBColor(176, 58, 46)),
    (None, "hits", RGBColor(120, 150, 120)),
];

/// Counts of each bin for each of [`CAUSES`] [hits].
pub type Causes = [Vec<u32>; CAUSES.len()];

/// Counts a shot, if it has a code.
pub fn count(causes: &mut Causes, shot: &Shot) {
    for ((cause, ..), counts) in CAUSES.iter().zip(causes) {
        if let (true, Some(code)) = (*cause == shot.cause, shot.code) {
            counts[code as usize] += 1;
        }
    }
}

/// Depth for a time of flight, half the speed of light [m/ns].
const M_PER_NS: f64 = 0.149_896_229;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordu32>>;

/// Draws the picture as SVG text, with the true and the estimated depth if they are known; an error only if
/// the plotting library fails.
pub fn svg(
    title: &str,
    causes: &Causes,
    tdc: &Tdc,
    true_depth_m: Option<f64>,
    depth_m: Option<f64>,
) -> Result<String> {
    let (first_ns, bin_ns) = (tdc.first_bin_ps * 1e-3, tdc.bin_ps * 1e-3);
    let end_ns = first_ns + bin_ns * tdc.bins as f64;
    let bins = tdc.bins as usize;
    let top = stack(causes, CAUSES.len(), bins);
    let peak = (0..bins).max_by_key(|&bin| (top[bin], bins - bin)).unwrap_or(0);
    let highest = top[peak] + top[peak] / 8 + 1;
    let depth: Range<f64> = first_ns * M_PER_NS..end_ns * M_PER_NS;
    picture(|canvas| {
        let mut chart = chart(canvas, title)
            .top_x_label_area_size(40)
            .build_cartesian_2d(first_ns..end_ns, 0..highest)?
            .set_secondary_coord(depth.clone(), 0..highest);
        chart
            .configure_mesh()
            .x_desc("time from the laser edge [ns]")
            .y_desc(format!("hits in a bin of {} ps", tdc.bin_ps))
            .x_labels(14)
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        chart.configure_secondary_axes().x_desc("depth [m]").x_labels(10).draw()?;
        bars(&mut chart, causes, bins, [first_ns, bin_ns])?;
        let peak_ns = first_ns + (peak as f64 + 0.5) * bin_ns;
        let peak_label = format!("peak: bin {peak}, {peak_ns:.4} ns");
        // The truth is broad and pale, so that an estimate over it is seen.
        let truth =
            |m: f64| (m / M_PER_NS, BLACK.mix(0.3).stroke_width(7), format!("true: {m:.4} m"));
        let estimated =
            |m: f64| (m / M_PER_NS, RED.mix(0.9).stroke_width(2), format!("estimated: {m:.4} m"));
        let peak = (peak_ns, BLACK.mix(0.6).stroke_width(1), peak_label);
        let lines = [true_depth_m.map(truth), Some(peak), depth_m.map(estimated)];
        for line in lines.into_iter().flatten() {
            upright(&mut chart, highest, line)?;
        }
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}

/// Returns the height of the first `layers` causes together, in each bin.
fn stack(causes: &Causes, layers: usize, bins: usize) -> Vec<u32> {
    let height = |bin: usize| causes[..layers].iter().map(|counts| counts[bin]).sum();
    (0..bins).map(height).collect()
}

/// Draws the causes on top of each other.
fn bars(chart: &mut Chart, causes: &Causes, bins: usize, [first_ns, bin_ns]: [f64; 2]) -> Drawn {
    for (layer, (_, name, colour)) in CAUSES.into_iter().enumerate() {
        let total: u32 = causes[layer].iter().sum();
        if total == 0 {
            continue;
        }
        let (below, above) = (stack(causes, layer, bins), stack(causes, layer + 1, bins));
        let style = colour.filled();
        let shown = (0..bins).filter(|&bin| above[bin] > below[bin]);
        let bar = |bin: usize| {
            let left = first_ns + bin as f64 * bin_ns;
            Rectangle::new([(left, below[bin]), (left + bin_ns, above[bin])], style)
        };
        chart
            .draw_series(shown.map(bar))?
            .label(format!("{name}: {total}"))
            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], style));
    }
    Ok(())
}

/// Draws an upright line with its label; a narrow one is dashed.
fn upright(chart: &mut Chart, highest: u32, (x, style, label): (f64, ShapeStyle, String)) -> Drawn {
    let ends = [(x, 0), (x, highest)];
    let drawn = if style.stroke_width > 2 {
        chart.draw_series(LineSeries::new(ends, style))?
    } else {
        chart.draw_series(DashedLineSeries::new(ends, 6, 4, style))?
    };
    drawn.label(label).legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], style));
    Ok(())
}
