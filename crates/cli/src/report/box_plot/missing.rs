//! The strip below the boxes: which part of the histograms has no estimate, or one far off.

use plotters::prelude::*;

use tofsim_learn::evaluation::{Group, Spread};

use crate::text::svg::{Canvas, Drawn};

use super::BoxPlot;

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
