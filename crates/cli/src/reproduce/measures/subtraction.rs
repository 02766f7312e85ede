//! Background subtraction: Fig. 5.5.

use rand::Rng;

use tofsim::error;
use tofsim::optics::BinProbabilities;
use tofsim::scenario::DEFAULT;
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::subtraction::Subtraction;
use tofsim_learn::estimation::{Estimator, Failure, HistogramPair};

use crate::page::plot::{BLUE, GREY, Layer, ORANGE, Shape};
use crate::report::pairs::right_of_echo;
use crate::reproduce::peaks::{SHOTS, WRONG_M};
use crate::reproduce::scenes::{BIN_NS, View, counts, detection};
use crate::reproduce::study::Study;
use crate::reproduce::values::Measured;

use super::histograms::mean_of;

/// Distance of the target [m].
const DISTANCE_M: f64 = 0.6;
/// Irradiance of each picture, by its letter [W/m^2/nm].
const LIGHTS: [(char, f64); 4] = [('a', 0.1), ('b', 0.2), ('c', 0.3), ('d', 0.4)];

pub(super) fn subtraction(study: &Study) -> error::Result<Measured> {
    let draws = study.size(1000, 100);
    let distance = format!("target.distance_m={DISTANCE_M}");
    let right = right_of_echo(&study.setup(DEFAULT, &["tdc.profile=ideal", &distance])?);
    let percent = |count: u64| 100.0 * count as f64 / draws as f64;
    let mut random = stream(study.seed, Source::Histogram, 55);
    let mut measured = Measured::default();
    measured.values.put("draws", draws as f64);
    // Two standard errors of a difference of two parts of a half [%].
    measured.values.put("noise", 2.0 * (2500.0 / draws as f64).sqrt());
    for (letter, irradiance) in LIGHTS {
        let view = View::new(study, DISTANCE_M, 0.6, irradiance)?;
        let pairs =
            Pairs::draw(&view, right.unwrap_or(view.codes.of_code().len()), draws, &mut random);
        let mut put =
            |name: &str, number: f64| measured.values.put(format!("{name}.{letter}"), number);
        put("irradiance", irradiance);
        put("negative", pairs.negative as f64);
        put("found", percent(pairs.found));
        put("found_alone", percent(pairs.found_alone));
        measured.values.put_figure(format!("right.{letter}"), mean_of(&pairs.right));
        measured = measured.layers(pairs.layers());
    }
    Ok(measured)
}

/// Returns whether a detector has found the target, and nothing else.
fn is_echo(found: Result<f64, Failure>) -> bool {
    found.is_ok_and(|depth_m| (depth_m - DISTANCE_M).abs() <= WRONG_M)
}

/// Pairs of a dark and a lit histogram of one irradiance.
struct Pairs {
    /// The first pair.
    shown: HistogramPair,
    /// Pairs with a negative count.
    negative: u64,
    /// Echoes found by subtraction.
    found: u64,
    /// Echoes found by peak detection in one lit histogram of all shots.
    found_alone: u64,
    /// Mean of the difference right of the echo, pair by pair [hits].
    right: Vec<f64>,
}

impl Pairs {
    /// Draws pairs; the bins from `right` on are those right of the echo.
    fn draw(view: &View, right: usize, draws: u64, random: &mut impl Rng) -> Self {
        let dark = view.dark();
        let both = Subtraction { detection: detection() };
        let mut draw = |codes: &BinProbabilities, shots| -> Vec<u32> {
            codes.draw(shots, random).into_iter().map(|count| count as u32).collect()
        };
        let shown = HistogramPair { dark: Vec::new(), lit: Vec::new() };
        let mut pairs = Pairs { shown, negative: 0, found: 0, found_alone: 0, right: Vec::new() };
        for k in 0..draws {
            let (dark, lit) = (draw(&dark, SHOTS / 2), draw(&view.codes, SHOTS / 2));
            let pair = HistogramPair { dark, lit };
            let difference = pair.difference();
            pairs.negative += u64::from(difference.iter().any(|count| *count < 0));
            let part = &difference[right..];
            pairs.right.push(part.iter().sum::<i32>() as f64 / part.len() as f64);
            let whole = draw(&view.codes, SHOTS);
            pairs.found += u64::from(is_echo(both.estimate_pair(&pair)));
            pairs.found_alone += u64::from(is_echo(detection().estimate(&whole)));
            if k == 0 {
                pairs.shown = pair;
            }
        }
        pairs
    }

    fn layers(&self) -> Vec<Layer> {
        let bars = |name: &str, colour, of: &[f64]| {
            let points = of.iter().enumerate().map(|(bin, count)| (bin as f64 * BIN_NS, *count));
            Layer::new(name, colour, Shape::Line, points)
        };
        let difference: Vec<_> = self.shown.difference().into_iter().map(f64::from).collect();
        vec![
            bars("Histogram 1, dark", GREY, &counts(&self.shown.dark)),
            bars("Histogram 2, lit", ORANGE, &counts(&self.shown.lit)),
            bars("Histogram 3, their difference", BLUE, &difference),
        ]
    }
}
