//! The network's errors: Table 5.5, Fig. 5.7, Fig. 6.17 and Table 6.5.

use plotters::style::BLACK;

use tofsim::error::Result;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::evaluation::thesis::{DISTANCES_M, FIXED, FLOAT, Published, allowed_error_mm};
use tofsim_learn::evaluation::{Figures, Group};

use crate::page::plot::{BLUE, GREY, Layer, ORANGE, Shape};
use crate::report::box_plot::{BoxPlot, Limit, Series};
use crate::reproduce::networks::{Networks, PATTERNS};
use crate::reproduce::published::{Sample, compared};
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

/// Histograms at a distance of the thesis's test.
const TEST: f64 = 2385.0;
/// Boxes of a picture.
const BOXES: usize = 26;

/// Means and spreads of a network beside those that the thesis has of so many histograms.
fn spreads(published: &Published, count: f64, figures: &Figures) -> Values {
    let of = Sample { count, freedom: count - 1.0 };
    compared(published, of, |at| figures.at(DISTANCES_M[at]).cloned().unwrap_or_default())
}

/// Values of the network over the thesis's test grid, before rounding.
fn over_the_grid(networks: &Networks) -> Values {
    let float = &networks.float;
    let mut values = spreads(&FLOAT, TEST, float);
    values.put("failures", float.all.failures as f64);
    values.put("outliers", float.all.outliers as f64);
    values.put("rows", networks.rows as f64);
    values.put("rows_at_a_distance", networks.rows_at_a_distance as f64);
    values.put("float_within", networks.within[0]);
    values.put("fixed_within", networks.within[1]);
    for (name, figures) in [("float", float), ("fixed", &networks.fixed)] {
        let two_sd_mm = figures.all.two_sd_mm.unwrap_or(f64::NAN);
        values.put(format!("{name}_two_sd_mm"), two_sd_mm);
    }
    values
}

pub(super) fn floating_point(study: &Study) -> Result<Measured> {
    let networks = study.networks()?;
    let svg = boxes("Errors less the median of their distance", &networks.float)?;
    Ok(Measured::from(over_the_grid(&networks)).svg(svg))
}

pub(super) fn both(study: &Study) -> Result<Measured> {
    let networks = study.networks()?;
    let float = boxes("(a) floating point", &networks.float)?;
    let fixed = boxes("(b) fixed point", &networks.fixed)?;
    Ok(Measured::from(over_the_grid(&networks)).svg(float).svg(fixed))
}

pub(super) fn hardware(study: &Study) -> Result<Measured> {
    let networks = study.networks()?;
    let mut values = spreads(&FIXED, PATTERNS as f64, &networks.patterns);
    values.put_all("grid.", spreads(&FIXED, PATTERNS as f64, &networks.fixed));
    Ok(values.into())
}

pub(super) fn depths(study: &Study) -> Result<Measured> {
    let networks = study.networks()?;
    let of = |part: usize| -> Vec<(f64, f64)> {
        let depth = |group: &Group| {
            Some((group.value, group.value + 1e-3 * group.spread.quartiles_mm?[part]))
        };
        networks.float.by_distance_m.iter().filter_map(depth).collect()
    };
    let medians = of(2);
    let mut values = over_the_grid(&networks);
    values.put("medians_rise", f64::from(medians.is_sorted_by(|a, b| a.1 < b.1)));
    values.put("distances", medians.len() as f64);
    let layers = vec![
        Layer::between("target depth", BLACK, [(0.1, 0.1), (0.6, 0.6)]),
        Layer::new("largest estimate", ORANGE, Shape::Line, of(4)),
        Layer::new("least estimate", GREY, Shape::Line, of(0)),
        Layer::new("median estimate", BLUE, Shape::Dots, medians),
    ];
    Ok(Measured::from(values).layers(layers))
}

/// Errors by distance as boxes, each less the median of its distance, between the limits of the specification.
fn boxes(title: &str, figures: &Figures) -> Result<String> {
    let distances: Vec<_> = figures.by_distance_m.iter().map(|group| group.value).collect();
    let shown = thinned(&distances, BOXES);
    let groups = figures.by_distance_m.iter().filter(|group| shown.contains(&group.value));
    let groups: Vec<_> = groups.map(normalised).collect();
    let series = [Series { name: figures.name, groups: &groups }];
    let plot = BoxPlot { title, quantity: "distance [m]", series: &series, limits: &[ALLOWED] };
    plot.svg()
}

/// A group whose median is at 0, as the thesis's "improved box-plot" has it.
fn normalised(group: &Group) -> Group {
    let mut group = group.clone();
    let Some(median) = group.spread.quartiles_mm.map(|quartiles| quartiles[2]) else {
        return group;
    };
    let spread = &mut group.spread;
    spread.quartiles_mm = spread.quartiles_mm.map(|all| all.map(|mm| mm - median));
    spread.mean_mm = spread.mean_mm.map(|mm| mm - median);
    if let Some(tails) = &mut spread.tails {
        tails.whiskers_mm = tails.whiskers_mm.map(|mm| mm - median);
        tails.beyond_mm.iter_mut().for_each(|mm| *mm -= median);
    }
    group
}

/// The error that the specification allows.
const ALLOWED: Limit =
    Limit { name: "specification (Table 5.2)", mm: allowed_error_mm, colour: BLACK };
