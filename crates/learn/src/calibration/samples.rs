//! A pulse without a formula: densities at even steps, by expectation and maximisation.
//!
//! Coates's correction tells how many shots wait in a bin, and for those its hits are linear in the density. Each
//! round shares out the hits of a bin among the samples whose light falls into it, as expected (Shepp and Vardi 1982), and
//! adds up what each sample got over what it should have got; then the echoes are fitted anew. Densities stay
//! above zero by themselves. Where they are not told from zero they are made zero, because chance alone, which is
//! never below, would move the mean.

use std::collections::BTreeMap;

use rayon::prelude::*;

use tofsim::error::{Input, Result};
use tofsim::kernel::pulse::{Pulse, Samples};

use crate::estimation::acquisition::{Acquisition, Echo, spans_ps};
use crate::estimation::coates::correct;

use super::Sightings;

/// Rounds between two fits of the echoes.
const ROUNDS: usize = 10;
/// Fits of the echoes.
const FITS: usize = 8;
/// Distance by which the samples exceed the ends of the initial pulse [its deviations].
const MARGIN: f64 = 1.0;
/// Fits after which what is not told from zero goes.
const TRIMMED: usize = 4;
/// Fewest standard errors of a density that is told from zero [1].
const TOLD: f64 = 1.0;
/// Most samples.
const MOST: usize = 2000;

/// A measured pulse.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// The pulse.
    pub pulse: Pulse,
    /// Time of each sample from the mean [ps].
    pub times_ps: Vec<f64>,
    /// Density there [1/ps].
    pub density: Vec<f64>,
    /// Its standard error, if all other samples were known [1/ps].
    pub density_se: Vec<f64>,
    /// Logarithm of the likelihood of the histograms, up to a constant.
    pub log_likelihood: f64,
}

/// A bin of a histogram after Coates's correction.
struct Seen {
    /// Begin and end from the echo's mean [ps]; the first bin begins before everything.
    span_ps: [f64; 2],
    /// Hits in it.
    hits: f64,
    /// Hits that the echo would make for each part of the pulse.
    lit: f64,
    /// Hits that other light would make.
    other: f64,
}

/// Checks that a pulse can be measured under the conditions of an acquisition.
///
/// # Errors
/// When shots are not armed at the laser edge, or clocks jitter.
pub fn check(acquisition: &Acquisition) -> Result<()> {
    if acquisition.free_running.is_some() {
        let expected = "expected 0 for a measured pulse: shots that are armed at the laser edge";
        return Err(Input::new("scenario", expected).field("firmware.mode").value(1).into());
    }
    if acquisition.jitter_ps > 0.0 {
        let expected = "expected 0 for a measured pulse: times that no jitter blurs";
        return Err(Input::new("scenario", expected).field("pll.jitter_rms_ps").into());
    }
    Ok(())
}

/// The density that histograms tell of, from a pulse that is near it; the sightings follow.
///
/// # Errors
/// When the step makes too few or too many samples, or the histograms leave no density.
pub fn sampled(
    acquisition: &Acquisition,
    sightings: &mut Sightings,
    near: &Pulse,
    step_ps: f64,
) -> Result<Sampled> {
    let sigma_ps = near.sigma_ps();
    let [begin_ps, end_ps] = near.ends_ps();
    let first_ps = begin_ps - MARGIN * sigma_ps;
    let count = ((end_ps - begin_ps + 2.0 * MARGIN * sigma_ps) / step_ps).ceil() as usize + 1;
    if !(5..=MOST).contains(&count) {
        let expected = format!("{count} samples from this step, expected 5 to {MOST}");
        return Err(Input::new("--step-ps", expected).value(step_ps).into());
    }
    let times_ps: Vec<_> = (0..count).map(|k| first_ps + k as f64 * step_ps).collect();
    let mut density: Vec<_> = times_ps.iter().map(|t_ps| near.density(*t_ps).max(1e-12)).collect();
    // The samples' mean moves when the density does: echoes are from the mean.
    let mut mean_ps = 0.0;
    let mut density_se = Vec::new();
    let mut log_likelihood = f64::NEG_INFINITY;
    let fault = |unusable| Input::new("calibrate", unusable);
    let mut pulse = near.clone();
    for fit in 0..FITS {
        let seen = seen(acquisition, sightings, mean_ps);
        for _ in 0..ROUNDS {
            let (gained, due, spread) = shared(&seen, &times_ps, &density, step_ps);
            for (k, density) in density.iter_mut().enumerate() {
                *density *= if due[k] > 0.0 { gained[k] / due[k] } else { 0.0 };
            }
            density_se = spread.iter().map(|spread| 1.0 / spread.max(1e-300).sqrt()).collect();
        }
        if fit == TRIMMED {
            trim(&mut density, &density_se);
        }
        let sum: f64 = density.iter().sum::<f64>() * step_ps;
        density.iter_mut().for_each(|density| *density /= sum);
        let terms = times_ps.iter().zip(&density);
        mean_ps = terms.map(|(t_ps, density)| t_ps * density * step_ps).sum();
        pulse = Pulse::Sampled(Samples::new(step_ps, &density).map_err(fault)?);
        log_likelihood = sightings.refit(acquisition, &pulse)?;
    }
    let times_ps = times_ps.iter().map(|t_ps| t_ps - mean_ps).collect();
    Ok(Sampled { pulse, times_ps, density, density_se, log_likelihood })
}

/// Makes zero what lies beyond two samples that are not told from zero, from the highest one on.
fn trim(density: &mut [f64], se: &[f64]) {
    let peak = (0..density.len()).max_by(|&a, &b| density[a].total_cmp(&density[b])).unwrap_or(0);
    let none = |k: usize| density[k] < TOLD * se[k];
    let end = (peak..density.len()).find(|&k| none(k) && none((k + 1).min(density.len() - 1)));
    let begin = (0..=peak).rev().find(|&k| none(k) && none(k.saturating_sub(1)));
    let kept = begin.map_or(0, |k| k + 1)..end.unwrap_or(density.len());
    for (k, density) in density.iter_mut().enumerate() {
        if !kept.contains(&k) {
            *density = 0.0;
        }
    }
}

/// Returns the pulse observed in the bins before any fit: time from the mean, density and its standard error, in
/// steps [ps, 1/ps, 1/ps].
pub fn shown(acquisition: &Acquisition, sightings: &Sightings, step_ps: f64) -> Vec<[f64; 3]> {
    let mut steps = BTreeMap::new();
    for bin in seen(acquisition, sightings, 0.0) {
        let [from_ps, until_ps] = bin.span_ps;
        if from_ps.is_finite() {
            let step = libm::round(0.5 * (from_ps + until_ps) / step_ps) as i64;
            let (hits, other, due) = steps.entry(step).or_insert((0.0, 0.0, 0.0));
            *hits += bin.hits;
            *other += bin.other;
            *due += bin.lit * (until_ps - from_ps);
        }
    }
    let point = |(step, (hits, other, due)): (i64, (f64, f64, f64))| {
        [step as f64 * step_ps, (hits - other) / due, hits.max(1.0).sqrt() / due]
    };
    steps.into_iter().map(point).collect()
}

/// All bins of all histograms; times are from the samples' zero, which is `mean_ps` before the pulse's mean.
fn seen(acquisition: &Acquisition, sightings: &Sightings, mean_ps: f64) -> Vec<Seen> {
    let spans: Vec<_> = spans_ps(acquisition.bins).collect();
    let of = |(histogram, echo): (&Vec<u32>, &Echo)| {
        let counts = spans.iter().map(|(code, ..)| histogram[*code as usize]);
        let corrected = correct(counts.clone(), acquisition.shots);
        let bins = spans.iter().zip(counts.zip(corrected));
        let bins = bins.map(|(&(_, from_ps, until_ps), (count, bin))| {
            let since = |t_ps: f64| t_ps - echo.arrival_ps + mean_ps;
            let begin_ps = if from_ps == 0.0 { f64::NEG_INFINITY } else { since(from_ps) };
            let hits = f64::from(count);
            // Shots that wait in the middle of the bin.
            let waiting = if bin.hazard > 0.0 { hits / bin.hazard } else { bin.waiting };
            Seen {
                span_ps: [begin_ps, since(until_ps)],
                hits,
                lit: waiting * echo.signal,
                other: waiting * echo.background_per_ps * (until_ps - from_ps),
            }
        });
        bins.collect::<Vec<_>>()
    };
    let histograms = sightings.histograms.iter().zip(&sightings.echoes);
    histograms.flat_map(of).filter(|bin| bin.lit > 0.0).collect()
}

/// Integral of a sample's triangle, of area 1, up to a time from its middle in steps [1].
fn passed(x: f64) -> f64 {
    match x {
        x if x <= -1.0 => 0.0,
        x if x <= 0.0 => 0.5 * (1.0 + x) * (1.0 + x),
        x if x <= 1.0 => 1.0 - 0.5 * (1.0 - x) * (1.0 - x),
        _ => 1.0,
    }
}

/// Returns the observed hits of each sample, the expected ones for a density of one, and the information on it.
fn shared(
    seen: &[Seen],
    times_ps: &[f64],
    density: &[f64],
    step_ps: f64,
) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let place = |t_ps: f64| (t_ps - times_ps[0]) / step_ps;
    let last = times_ps.len() - 1;
    let add = |(mut gained, mut due, mut spread): (Vec<f64>, Vec<f64>, Vec<f64>), bin: &Seen| {
        let [from, until] = bin.span_ps.map(place);
        let first = (from - 1.0).max(0.0) as usize;
        let end = (until + 1.0).clamp(-1.0, last as f64);
        if end < 0.0 || first > last {
            return (gained, due, spread);
        }
        let range = first..=end as usize;
        let parts: Vec<_> = (range.clone())
            .map(|k| step_ps * (passed(until - k as f64) - passed(from - k as f64)))
            .collect();
        let own: f64 = parts.iter().zip(&density[range.clone()]).map(|(part, d)| part * d).sum();
        let expected = bin.other + bin.lit * own;
        if expected > 0.0 {
            for (part, k) in parts.iter().zip(range) {
                gained[k] += bin.lit * part * bin.hits / expected;
                due[k] += bin.lit * part;
                spread[k] += bin.lit * part * bin.lit * part / expected;
            }
        }
        (gained, due, spread)
    };
    let none = || (vec![0.0; last + 1], vec![0.0; last + 1], vec![0.0; last + 1]);
    // Parts of one size and in one order, so that sums do not hang on the threads.
    let parts: Vec<_> = seen.par_chunks(4096).map(|part| part.iter().fold(none(), add)).collect();
    parts.into_iter().fold(none(), |mut sums, part| {
        for (sum, part) in [(&mut sums.0, part.0), (&mut sums.1, part.1), (&mut sums.2, part.2)] {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        sums
    })
}
