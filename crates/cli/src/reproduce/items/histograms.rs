//! Histograms of the model, and what they show: Fig. 3.3, 4.1, 5.1.

use tofsim::error::{Input, Result};
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::sim::shot_recorder::Shot;

use crate::page::plot::{BLUE, Layer, Plot};
use crate::report::{causes, histogram_svg};
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::peaks::{Peaks, SHOTS};
use crate::reproduce::scenes::{BIN_NS, View, bars, counts, detection, mean, upright};
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 3] = [
    Item::made("fig-3.3", "Histogram of the model", model),
    Item::made("fig-4.1", "Peak shift and background in a histogram", shift),
    Item::made("fig-5.1", "Histogram by what caused the counts", by_cause),
];

const AXES: [&str; 2] = ["time from the laser edge [ns]", "hits in a bin of 25 ps"];
/// Half of what an echo takes, with room [ns].
const ECHO_NS: f64 = 0.6;

fn model(study: &Study) -> Result<Finding> {
    let view = View::new(study, 0.5, 0.34, 0.2)?;
    let counts = counts(&view.histogram(study, 0));
    let arrival_ns = 1e-3 * Peaks::arrival_ps(0.5);
    let before = mean(&counts, arrival_ns - ECHO_NS - 1.0, arrival_ns - ECHO_NS);
    let after = mean(&counts, arrival_ns + ECHO_NS, arrival_ns + ECHO_NS + 1.0);
    // Each is a mean over 40 bins.
    let error = |mean: f64| (mean / 40.0).sqrt();
    let rows = [
        Row::claim(
            "the floor is higher left of the echo than right of it",
            before - after > 2.0 * error(before).hypot(error(after)),
            format!("{before:.1} and {after:.1} hits a bin"),
        ),
        Row::ours_alone(
            "floor in the nanosecond before the echo",
            "hits",
            Number::new(before, 1).with_error(error(before)),
        ),
        Row::ours_alone(
            "floor in the nanosecond after it",
            "hits",
            Number::new(after, 1).with_error(error(after)),
        ),
    ];
    let plot = Plot {
        title: "0.5 m, 34 %, 0.2 W/m^2/nm, 30,000 shots",
        axes: AXES,
        layers: vec![bars(&counts)],
    };
    let reason = "The figure's distance, reflectance and light are not printed.";
    Finding::of(rows)
        .because(reason)
        .shown_by("tofsim run --fidelity histogram -s tdc.profile=ideal -o out")
        .with_plot(&plot, "Ambient avalanches end shots before the echo, and the echo ends shots before later ones.")
}

fn shift(study: &Study) -> Result<Finding> {
    let (distance_m, reflectance) = (0.2, 0.34);
    let view = View::new(study, distance_m, reflectance, 0.2)?;
    let (detection, arrival_ps) = (detection(), Peaks::arrival_ps(distance_m));
    let draws = study.size(2000, 200);
    let shift = |number: u64| {
        let counts = counts(&view.histogram(study, 1000 + number));
        let peaks = detection.peaks(&counts);
        peaks.first().filter(|_| peaks.len() == 1).map(|peak| peak.location - arrival_ps)
    };
    let shifts: Vec<f64> = (0..draws).filter_map(shift).collect();
    let n = shifts.len().max(2) as f64;
    let mean_ps = shifts.iter().sum::<f64>() / n;
    let variance = shifts.iter().map(|ps| (ps - mean_ps).powi(2)).sum::<f64>() / (n - 1.0);
    let error_ps = (variance / n).sqrt();
    let histogram = counts(&view.histogram(study, 1000));
    let (_, ambient_hz) = view.light();
    // Shots that are left over times the rate.
    let floor =
        |ns: f64| SHOTS as f64 * ambient_hz * BIN_NS * 1e-9 * (-ambient_hz * ns * 1e-9).exp();
    let first = mean(&histogram, 0.0, 0.5);
    let first_error = (first / 20.0).sqrt();
    let rows = [
        Row::claim(
            "the peak is shifted from the target's position",
            mean_ps.abs() > 2.0 * error_ps,
            format!("{mean_ps:.1} +- {error_ps:.1} ps: early"),
        ),
        Row::claim(
            "there is background noise",
            first > 2.0 * first_error,
            format!("{first:.0} +- {first_error:.0} hits a bin"),
        ),
        Row::ours_alone(
            "shift",
            "mm",
            Number::new(mean_ps * 0.149_896, 1).with_error(error_ps * 0.149_896),
        ),
    ];
    let height = histogram.iter().copied().fold(0.0, f64::max);
    let (at, peak) = (arrival_ps * 1e-3, (arrival_ps + mean_ps) * 1e-3);
    let curve = (0..256).map(|bin| bin as f64 * BIN_NS).filter(|ns| *ns < at - 0.3);
    let layers = vec![
        bars(&histogram),
        upright(format!("target: {at:.3} ns"), at, height),
        Layer::between(
            format!("mean detected peak: {peak:.3} ns"),
            BLUE,
            [(peak, 0.0), (peak, height)],
        ),
        Layer::new(
            "background of the model",
            plotters::style::BLACK,
            crate::page::plot::Shape::Line,
            curve.map(|ns| (ns, floor(ns))),
        ),
    ];
    let plot = Plot { title: "0.2 m, 34 %, 0.2 W/m^2/nm, 30,000 shots", axes: AXES, layers };
    let reason = "The first photon of several in a pulse is an early one: the peak is before the target. The figure's own scene \
                  is not printed. The smoothed curve has a point each 64 ps, and the peak is one of them.";
    let words =
        format!("Shift of the peak, over {draws} draws, and background, marked in one histogram.");
    Finding::of(rows).because(reason).with_plot(&plot, words)
}

fn by_cause(study: &Study) -> Result<Finding> {
    let set = ["tdc.profile=ideal", "estimator.network=ideal", "target.distance_m=0.3"];
    let setup = study.setup("kc705", &set)?;
    let mut causes: causes::Causes = std::array::from_fn(|_| vec![0; setup.params.histogram.bins]);
    let mut take = |shot: &Shot| {
        causes::count(&mut causes, shot);
        Ok(())
    };
    let watch = Observers { shots: Some(&mut take), stop: study.stop(), ..Observers::default() };
    Run::new(&setup).observe(1, watch)?;
    let of = |name: &str| -> &[u32] {
        let place = causes::CAUSES.iter().position(|(_, known, _)| *known == name);
        place.map_or(&[], |place| &causes[place])
    };
    let (signal, ambient) = (of("signal"), of("ambient"));
    let both = signal.iter().zip(ambient).filter(|(a, b)| **a > 0 && **b > 0).count();
    let rows = [
        Row::claim(
            "counts of signal and of noise overlap (section 7.3)",
            both > 0,
            format!("{both} bins have both"),
        ),
        Row::ours_alone(
            "counts of signal",
            "",
            Number::new(f64::from(signal.iter().sum::<u32>()), 0),
        ),
        Row::ours_alone(
            "counts of noise",
            "",
            Number::new(f64::from(ambient.iter().sum::<u32>()), 0),
        ),
    ];
    let title = "0.3 m, 34 %, 0.2 W/m^2/nm, through every register";
    let svg = histogram_svg::svg(title, &causes, &setup.scenario.tdc, setup.true_depth_m(), None);
    let svg = svg.map_err(|fault| Input::new("fig-5.1", fault))?;
    let words = "Counts by their cause, which only a simulation knows.";
    let command = "tofsim run -s tdc.profile=ideal -s estimator.network=ideal -s target.distance_m=0.3 -o out";
    let reason = "The figure's scene is random within the ranges of Table 3.2.";
    Ok(Finding::of(rows).because(reason).with_figure(svg, words, true).shown_by(command))
}
