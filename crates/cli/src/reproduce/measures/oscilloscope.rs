//! Fig. 6.7: the SPAD's output on an oscilloscope, as a stated model.

use plotters::style::RGBColor;

use tofsim::error::Result;

use crate::page::plot::{BLUE, GREY, Layer, Shape};
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

/// Time constants of the path, each a low pass of the first order: the pad's driver into its pair, and the board with
/// the probe. Our assumptions: edges of 0.4 and 0.9 ns from 10 to 90 % [ns].
const LVDS_NS: f64 = 0.4 / 2.197;
const BOARD_NS: f64 = 0.9 / 2.197;
/// Width of the screen, step of its curves, and width of its histogram's bins [ns].
const SCREEN_NS: f64 = 12.0;
const STEP_NS: f64 = 0.1;
const BIN_NS: f64 = 0.2;
/// Shots whose edges are drawn.
const DRAWN: usize = 12;

/// The edge that a step at 0 becomes after both low passes [1].
fn edge(ns: f64) -> f64 {
    if ns <= 0.0 {
        return 0.0;
    }
    let [a, b] = [LVDS_NS, BOARD_NS];
    1.0 - (a * (-ns / a).exp() - b * (-ns / b).exp()) / (a - b)
}

pub(super) fn screen(study: &Study) -> Result<Measured> {
    let setup = study.setup("kc705", &["target.distance_m=0.6"])?;
    let shots = study.shots(&setup)?;
    let arrivals = shots.iter().filter_map(|shot| Some(shot.arrival_fs? as f64 * 1e-6));
    let arrivals: Vec<_> = arrivals.filter(|ns| (0.0..SCREEN_NS).contains(ns)).collect();
    let curve = |arrival: &f64| {
        let steps = (SCREEN_NS / STEP_NS) as usize;
        let at = move |k: usize| k as f64 * STEP_NS;
        let points = (0..=steps).map(|k| (at(k), edge(at(k) - arrival))).collect::<Vec<_>>();
        Layer::new("", RGBColor(160, 190, 220), Shape::Line, points)
    };
    let mut counts = vec![0u32; (SCREEN_NS / BIN_NS) as usize];
    arrivals.iter().for_each(|ns| counts[(ns / BIN_NS) as usize] += 1);
    let highest = f64::from(counts.iter().copied().max().unwrap_or(1).max(1));
    let bars = counts.iter().enumerate();
    let bars = bars.map(|(bin, count)| (bin as f64 * BIN_NS, 0.5 * f64::from(*count) / highest));
    let mut layers =
        vec![Layer::new("accumulated histogram of the edges", GREY, Shape::Bars, bars)];
    layers.extend(arrivals.iter().take(DRAWN).map(curve));
    let mean = |k: usize| {
        let at = k as f64 * STEP_NS;
        let sum: f64 = arrivals.iter().map(|arrival| edge(at - arrival)).sum();
        (at, sum / arrivals.len().max(1) as f64)
    };
    let means: Vec<_> = (0..=(SCREEN_NS / STEP_NS) as usize).map(mean).collect();
    layers.push(Layer::new("mean of all shots with a hit", BLUE, Shape::Line, means));
    let rise = |part: f64| (0..100_000).map(|k| k as f64 * 1e-4).find(|ns| edge(*ns) >= part);
    let rise_ns = rise(0.9).unwrap_or(f64::NAN) - rise(0.1).unwrap_or(f64::NAN);
    let mut values = Values::default();
    values.put("rise_ns", rise_ns);
    values.put("shots", arrivals.len() as f64);
    values.put("drawn", DRAWN as f64);
    Ok(Measured::from(values).layers(layers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_begins_at_nothing_and_ends_at_all() {
        assert_eq!(edge(-1.0), 0.0);
        assert!(edge(0.01) < 0.01 && edge(10.0) > 0.999);
        assert!((0..50).all(|k| edge(0.1 * f64::from(k)) <= edge(0.1 * f64::from(k + 1))));
    }
}
