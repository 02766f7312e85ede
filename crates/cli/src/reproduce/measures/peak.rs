//! Peak detection: where it finds the echo (Listings 5.1 to 5.3, Fig. 5.4, Table 5.2), and where nothing (Table 4.3, Fig. 5.3).

use tofsim::error::Result;
use tofsim_learn::evaluation::thesis::{
    DISTANCES_M, PEAK, PEAK_FAILURES, PEAK_TRIALS, allowed_error_mm,
};

use crate::page::plot::{BLUE, GREY, Layer, Shape};
use crate::reproduce::peaks::{Peaks, SHOTS};
use crate::reproduce::published::{Sample, compared};
use crate::reproduce::scenes::{View, bars, counts, curve, detection, features, target};
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

/// Detections that the thesis's figures are of.
const SAMPLE: Sample = Sample { count: 1000.0, freedom: 1000.0 };

pub(super) fn compensation(study: &Study) -> Result<Measured> {
    let (peaks, detection) = (study.peaks()?, detection());
    let (x, _) = detection.curve(&[1.0; 256]).unwrap_or_default();
    let [slope, offset_m] = peaks.compensation();
    let mut values = Values::default();
    values.put("points", x.len() as f64);
    values.put("prominence", detection.prominence * SHOTS as f64);
    values.put_figure("slope", slope);
    values.put_figure("offset_m", offset_m);
    // Where the peaks of a distance are, before the compensation [m].
    let place = |(truth, errors): (f64, &Vec<f64>)| {
        let places =
            errors.iter().map(|error| (truth + error - detection.offset_m) / detection.slope);
        (places.sum::<f64>() / errors.len().max(1) as f64, truth)
    };
    let means: Vec<_> = DISTANCES_M.into_iter().zip(&peaks.errors_m).map(place).collect();
    let line = |k: f64, b: f64| {
        let off = move |(place, truth): &(f64, f64)| (*truth, 1e3 * (k * place + b - truth));
        means.iter().map(off).collect::<Vec<_>>()
    };
    let thesis = line(detection.slope, detection.offset_m);
    let layers = vec![
        Layer::new("thesis's K_d and B_d", GREY, Shape::Line, thesis),
        Layer::new("fitted here", BLUE, Shape::Line, line(slope.0, offset_m.0)),
    ];
    Ok(Measured::from(values).layers(layers))
}

/// Depths and errors at each distance beside the thesis's.
fn spreads(peaks: &Peaks) -> Values {
    compared(&PEAK, SAMPLE, |at| peaks.spread(at))
}

pub(super) fn errors(study: &Study) -> Result<Measured> {
    let peaks = study.peaks()?;
    let mut values = spreads(&peaks);
    for (m, errors) in DISTANCES_M.into_iter().zip(&peaks.errors_m) {
        let allowed_mm = allowed_error_mm(m);
        let within = errors.iter().filter(|error| 1e3 * error.abs() <= allowed_mm).count();
        values.put(format!("allowed_mm.{m}"), allowed_mm);
        let percent = 100.0 * within as f64 / errors.len().max(1) as f64;
        values.put(format!("percent_within.{m}"), percent);
    }
    Ok(values.into())
}

/// Reflectance and irradiance of the histograms of Fig. 5.4, within the ranges of the specification [1, W/m^2/nm].
const LIGHTS: [(f64, f64); 6] =
    [(0.3, 0.1), (0.45, 0.15), (0.2, 0.3), (0.34, 0.2), (0.15, 0.05), (0.5, 0.1)];

pub(super) fn examples(study: &Study) -> Result<Measured> {
    let (peaks, detection) = (study.peaks()?, detection());
    let mut measured = Measured::from(spreads(&peaks));
    for (k, ((reflectance, irradiance), distance_m)) in
        LIGHTS.into_iter().zip(DISTANCES_M).enumerate()
    {
        let view = View::new(study, distance_m, reflectance, irradiance)?;
        let histogram = counts(&view.histogram(study, 20_000 + k as u64));
        let mut layers = vec![bars(&histogram), curve(&detection, &histogram)];
        let found = detection.peaks(&histogram);
        if let [peak] = &found[..] {
            layers.extend(features(peak, &detection, &histogram));
        }
        layers.push(target(distance_m, &histogram));
        let found = match &found[..] {
            [peak] => format!("Depth of this one: {:.4} m.", detection.distance_m(peak.location)),
            other => format!("{} peaks.", other.len()),
        };
        let letter = (b'a' + k as u8) as char;
        let values = &mut measured.values;
        values.put(format!("distance_m.{letter}"), distance_m);
        values.put(format!("reflectance.{letter}"), reflectance);
        values.put(format!("irradiance.{letter}"), irradiance);
        values.put_words(format!("found.{letter}"), found);
        measured = measured.layers(layers);
    }
    Ok(measured)
}

/// Distance of the target of Fig. 5.3 [m].
const DISTANCE_M: f64 = 0.6;

pub(super) fn failures(study: &Study) -> Result<Measured> {
    let peaks = study.peaks()?;
    let scale = PEAK_TRIALS as f64 / peaks.trials as f64;
    // The standard error of a Poisson count, of one at least.
    let error = |count: u64| (count.max(1) as f64).sqrt();
    let mut values = Values::default();
    for (at, m) in DISTANCES_M.into_iter().enumerate() {
        let (printed, ours) = (PEAK_FAILURES[at], peaks.failures[at]);
        values.put_figure(format!("printed.{m}"), (printed as f64, error(printed)));
        values.put_figure(format!("failures.{m}"), (scale * ours as f64, scale * error(ours)));
        values.put(format!("wrong.{m}"), scale * peaks.wrong[at] as f64);
    }
    values.put("repeats", (peaks.trials / 300) as f64);
    values.put_words("seed", study.seed.to_string());
    let grid: Vec<_> = peaks.options.iter().map(|option| format!("--grid {option}")).collect();
    values.put_words("grid", grid.join(" "));
    Ok(values.into())
}

pub(super) fn failed_histogram(study: &Study) -> Result<Measured> {
    let view = View::new(study, DISTANCE_M, 0.6, 0.4)?;
    let detection = detection();
    let draws = study.size(2000, 300);
    let histogram = |number| counts(&view.histogram(study, 10_000 + number));
    let failed: Vec<u64> =
        (0..draws).filter(|k| detection.peaks(&histogram(*k)).is_empty()).collect();
    let shown = histogram(failed.first().copied().unwrap_or(0));
    let arrival_ns = 1e-3 * Peaks::arrival_ps(DISTANCE_M);
    let (x, y) = detection.curve(&shown).unwrap_or_default();
    let near = |k: &usize| (x[*k] * 1e-3 - arrival_ns).abs() < 0.3;
    let hump = (0..x.len()).filter(near).max_by(|a, b| y[*a].total_cmp(&y[*b])).unwrap_or(0);
    let before = (0..hump).rev().map(|k| y[k]).take(10).fold(f64::INFINITY, f64::min);
    let mut values = Values::default();
    values.put("draws", draws as f64);
    values.put("failed", failed.len() as f64);
    values.put("protuberance", y[hump] - before);
    values.put("at_ns", x[hump] * 1e-3);
    values.put("prominence", detection.prominence * SHOTS as f64);
    let layers = vec![bars(&shown), curve(&detection, &shown), target(DISTANCE_M, &shown)];
    Ok(Measured::from(values).layers(layers))
}
