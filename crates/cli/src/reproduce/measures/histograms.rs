//! Histograms of the model, and what they show: Fig. 3.3, 4.1 and 5.1.

use tofsim::error::Result;

use crate::page::plot::{BLUE, Layer, Shape};
use crate::report::causes;
use crate::reproduce::peaks::{Peaks, SHOTS};
use crate::reproduce::scenes::{BIN_NS, View, bars, counts, detection, height, mean, target};
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

/// Half of what an echo takes, with room [ns].
const ECHO_NS: f64 = 0.6;
/// Distance over the time that light takes there and back [mm/ps].
const MM_PER_PS: f64 = 0.149_896;

pub(super) fn model(study: &Study) -> Result<Measured> {
    let view = View::new(study, 0.5, 0.34, 0.2)?;
    let counts = counts(&view.histogram(study, 0));
    let arrival_ns = 1e-3 * Peaks::arrival_ps(0.5);
    let before = mean(&counts, arrival_ns - ECHO_NS - 1.0, arrival_ns - ECHO_NS);
    let after = mean(&counts, arrival_ns + ECHO_NS, arrival_ns + ECHO_NS + 1.0);
    // Each is a mean over 40 bins.
    let error = |mean: f64| (mean / 40.0).sqrt();
    let mut values = Values::default();
    values.put_figure("before", (before, error(before)));
    values.put_figure("after", (after, error(after)));
    values.put("twice_the_error", 2.0 * error(before).hypot(error(after)));
    Ok(Measured::from(values).layers(vec![bars(&counts)]))
}

pub(super) fn peak_shift(study: &Study) -> Result<Measured> {
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
    let (mean_ps, error_ps) = mean_of(&shifts);
    let histogram = counts(&view.histogram(study, 1000));
    let first = mean(&histogram, 0.0, 0.5);
    let mut values = Values::default();
    values.put("draws", draws as f64);
    values.put("mean_ps", mean_ps);
    values.put("magnitude_ps", mean_ps.abs());
    values.put("error_ps", error_ps);
    values.put("first", first);
    values.put("first_error", (first / 20.0).sqrt());
    values.put_figure("shift_mm", (mean_ps * MM_PER_PS, error_ps * MM_PER_PS));
    let (at, peak) = (arrival_ps * 1e-3, (arrival_ps + mean_ps) * 1e-3);
    // Shots that are left over times the rate.
    let (_, ambient_hz) = view.light();
    let floor =
        |ns: f64| SHOTS as f64 * ambient_hz * BIN_NS * 1e-9 * (-ambient_hz * ns * 1e-9).exp();
    let curve = (0..256).map(|bin| bin as f64 * BIN_NS).filter(|ns| *ns < at - 0.3);
    let curve = curve.map(|ns| (ns, floor(ns)));
    let found = format!("mean detected peak: {peak:.3} ns");
    let layers = vec![
        bars(&histogram),
        target(distance_m, &histogram),
        Layer::between(found, BLUE, [(peak, 0.0), (peak, height(&histogram))]),
        Layer::new("background of the model", plotters::style::BLACK, Shape::Line, curve),
    ];
    Ok(Measured::from(values).layers(layers))
}

/// The mean of numbers, and its standard error.
pub(super) fn mean_of(numbers: &[f64]) -> (f64, f64) {
    let n = numbers.len().max(2) as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let variance = numbers.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

pub(super) fn by_cause(study: &Study) -> Result<Measured> {
    let set = ["tdc.profile=ideal", "estimator.network=ideal", "target.distance_m=0.3"];
    let setup = study.setup("kc705", &set)?;
    let mut causes: causes::Causes = std::array::from_fn(|_| vec![0; setup.params.histogram.bins]);
    study.shots(&setup)?.iter().for_each(|shot| causes::count(&mut causes, shot));
    let of = |name: &str| -> &[u32] {
        let place = causes::CAUSES.iter().position(|(_, known, _)| *known == name);
        place.map_or(&[], |place| &causes[place])
    };
    let (signal, ambient) = (of("signal"), of("ambient"));
    let mut values = Values::default();
    let both = signal.iter().zip(ambient).filter(|(a, b)| **a > 0 && **b > 0).count();
    values.put("both", both as f64);
    values.put("signal", f64::from(signal.iter().sum::<u32>()));
    values.put("ambient", f64::from(ambient.iter().sum::<u32>()));
    let title = "0.3 m, 34 %, 0.2 W/m^2/nm, through every register";
    let svg = causes::svg(title, &causes, &setup.scenario.tdc, setup.true_depth_m(), None);
    Ok(Measured::from(values).svg(svg?))
}
