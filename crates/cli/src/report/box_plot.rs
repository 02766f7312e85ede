//! Errors by a quantity of the scene, as boxes.

use plotters::prelude::*;

use tofsim_learn::evaluation::Group;

use crate::text::svg::{chart, picture};

/// Whiskers reach so many heights of the box at most, and not past the last error.
const WHISKER: f64 = 1.5;

/// A group's value and its box: whiskers, quartiles and median [mm]; none without errors.
fn five(group: &Group) -> Option<(f64, [f64; 5])> {
    let [least, lower, median, upper, largest] = group.spread.quartiles_mm?;
    let reach = WHISKER * (upper - lower);
    let whiskers = [least.max(lower - reach), largest.min(upper + reach)];
    Some((group.value, [whiskers[0], lower, median, upper, whiskers[1]]))
}

/// The picture as SVG text: a box for each group of a quantity, with its unit, and on both sides half of the
/// spread to compare with at each group's value, if there is one [mm]; an error only if the plotting
/// library fails.
pub fn svg(
    title: &str,
    quantity: &str,
    groups: &[Group],
    beside_mm: Option<fn(f64) -> f64>,
) -> Result<String, String> {
    let boxes: Vec<_> = groups.iter().filter_map(five).collect();
    let values: Vec<_> = groups.iter().map(|group| group.value).collect();
    let (first, last) = (values.first().copied(), values.last().copied());
    let (first, last) = (first.unwrap_or(0.0), last.unwrap_or(1.0));
    let apart = if values.len() > 1 { (last - first) / (values.len() - 1) as f64 } else { 1.0 };
    let whiskers = boxes.iter().flat_map(|(_, five)| [five[0].abs(), five[4].abs()]);
    let beside = values.iter().filter_map(|&value| Some(beside_mm?(value)));
    let highest = 1.1 * whiskers.chain(beside).fold(0.1, f64::max);
    picture(|canvas| {
        let mut chart = chart(canvas, title)
            .build_cartesian_2d(first - apart..last + apart, -highest..highest)?;
        chart
            .configure_mesh()
            .x_desc(quantity)
            .y_desc("error of the depth [mm]")
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        for sign in [-1.0, 1.0] {
            let Some(beside) = beside_mm else { break };
            let line = values.iter().map(|&value| (value, sign * beside(value)));
            chart.draw_series(LineSeries::new(line, RED.mix(0.6).stroke_width(2)))?;
        }
        let half = 0.3 * apart;
        let ink = BLUE.mix(0.8);
        for (value, [low, lower, median, upper, high]) in boxes {
            let line = |from, to| PathElement::new(vec![from, to], ink);
            chart.draw_series([
                line((value, low), (value, lower)),
                line((value, upper), (value, high)),
            ])?;
            chart.draw_series([Rectangle::new(
                [(value - half, lower), (value + half, upper)],
                BLUE.mix(0.25).filled(),
            )])?;
            chart.draw_series([line((value - half, median), (value + half, median))])?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim_learn::evaluation::Spread;

    #[test]
    fn whiskers_stop_at_one_and_a_half_boxes() {
        let errors = [-100.0, -1.0, 0.0, 1.0, 2.0];
        let spread = Spread::of(errors.map(|mm| Some(1e-3 * mm)));
        let (value, five) = super::five(&Group { value: 0.3, spread }).unwrap();
        assert_eq!(value, 0.3);
        for (found, expected) in five.into_iter().zip([-4.0, -1.0, 0.0, 1.0, 2.0]) {
            assert!((found - expected).abs() < 1e-9, "{five:?}");
        }
    }

    #[test]
    fn a_picture_has_a_box_for_each_group_that_has_errors() {
        let group = |value, errors: &[f64]| Group {
            value,
            spread: Spread::of(errors.iter().map(|&error| Some(error))),
        };
        let groups = [group(0.1, &[0.001, 0.002]), group(0.2, &[]), group(0.3, &[-0.001, 0.0])];
        let svg = |groups| super::svg("network", "distance [m]", groups, Some(|_| 1.0));
        let drawn = svg(&groups).unwrap();
        let filled = drawn.matches("<rect").count();
        assert_eq!(filled, 1 + 2, "background and boxes");
        assert_eq!(svg(&groups).unwrap(), drawn);
        assert!(svg(&[]).is_ok());
    }
}
