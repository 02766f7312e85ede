//! Background subtraction: Fig. 5.5.

use rand::Rng;

use tofsim::error;
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::subtraction::Subtraction;
use tofsim_learn::estimation::{Estimator, Failure, HistogramPair};

use crate::page::plot::{BLUE, GREY, Layer, ORANGE, Plot, Shape};
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::peaks::{SHOTS, WRONG_M};
use crate::reproduce::scenes::{BIN_NS, View, counts, detection};
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 1] =
    [Item::made("fig-5.5", "Subtraction of a dark histogram", subtraction)];

/// Distance of the target [m].
const DISTANCE_M: f64 = 0.6;
const LIGHTS: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
/// Bins right of the echo at 0.6 m.
const RIGHT: usize = 180;

fn subtraction(study: &Study) -> error::Result<Finding> {
    let draws = study.size(1000, 100);
    let mut finding = Finding::default();
    let mut random = stream(study.seed, Source::Histogram, 55);
    for (k, irradiance) in LIGHTS.into_iter().enumerate() {
        let view = View::new(study, DISTANCE_M, 0.6, irradiance)?;
        let cell = Cell::measure(&view, draws, &mut random);
        let name = (b'a' + k as u8) as char;
        finding.rows.extend(cell.rows(name, draws));
        let title = format!("({name}) 0.6 m, 60 %, {irradiance} W/m^2/nm, 15,000 shots each");
        let bars = |name: &str, colour, of: &[f64]| {
            let points = of.iter().enumerate().map(|(bin, count)| (bin as f64 * BIN_NS, *count));
            Layer::new(name, colour, Shape::Line, points)
        };
        let layers = vec![
            bars("Histogram 1, dark", GREY, &counts(&cell.shown.dark)),
            bars("Histogram 2, lit", ORANGE, &counts(&cell.shown.lit)),
            bars("Histogram 3, their difference", BLUE, &cell.difference()),
        ];
        let axes = ["time from the laser edge [ns]", "hits in a bin of 25 ps"];
        finding = finding.with_plot(&Plot { title: &title, axes, layers }, "The first pair.")?;
    }
    let reason = "Histogram 3 has negative counts, and on average less than nothing right of the echo: a shot that the echo \
                  ended counts no ambient photon any more. The floor is gone, but its noise is not, and the echo is of half \
                  the shots: this \
                  detector does not find the echo more often than in one lit histogram of all 30,000.";
    Ok(finding
        .because(reason)
        .shown_by("tofsim evaluate ideal --profile ideal --estimator peak,subtraction --check 0"))
}

/// Whether a detector has found the target, and nothing else.
fn is_echo(found: Result<f64, Failure>) -> bool {
    found.is_ok_and(|depth_m| (depth_m - DISTANCE_M).abs() <= WRONG_M)
}

/// Pairs of one light.
struct Cell {
    shown: HistogramPair,
    /// Pairs with a negative count.
    negative: u64,
    /// Echoes found by subtraction, and of peak detection on one histogram of all shots.
    found: [u64; 2],
    /// Means of the difference right of the echo, pair by pair [hits].
    right: Vec<f64>,
}

impl Cell {
    fn measure(view: &View, draws: u64, random: &mut impl Rng) -> Self {
        let dark = view.dark();
        let both = Subtraction { detection: detection() };
        let mut draw = |codes: &tofsim::optics::BinProbabilities, shots| -> Vec<u32> {
            codes.draw(shots, random).into_iter().map(|count| count as u32).collect()
        };
        let mut shown = None;
        let (mut negative, mut found, mut right) = (0, [0; 2], Vec::new());
        for _ in 0..draws {
            let (dark, lit) = (draw(&dark, SHOTS / 2), draw(&view.codes, SHOTS / 2));
            let pair = HistogramPair { dark, lit };
            let difference = pair.difference();
            negative += u64::from(difference.iter().any(|count| *count < 0));
            let part = &difference[RIGHT..];
            right.push(part.iter().sum::<i32>() as f64 / part.len() as f64);
            let whole = draw(&view.codes, SHOTS);
            found[0] += u64::from(is_echo(both.estimate_pair(&pair)));
            found[1] += u64::from(is_echo(detection().estimate(&whole)));
            shown.get_or_insert(pair);
        }
        let shown = shown.unwrap_or(HistogramPair { dark: Vec::new(), lit: Vec::new() });
        Cell { shown, negative, found, right }
    }

    fn difference(&self) -> Vec<f64> {
        self.shown.difference().into_iter().map(f64::from).collect()
    }

    fn rows(&self, name: char, draws: u64) -> [Row; 3] {
        let n = self.right.len().max(2) as f64;
        let mean = self.right.iter().sum::<f64>() / n;
        let variance = self.right.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let percent = |count: u64| 100.0 * count as f64 / draws as f64;
        let [both, alone] = self.found.map(percent);
        let chance = 2.0 * (2500.0 / draws as f64).sqrt();
        [
            Row::claim(
                format!("({name}) Histogram 3 has negative counts"),
                self.negative == draws,
                format!("{} of {draws} have", self.negative),
            ),
            Row::claim(
                format!("({name}) the peak is easier to find"),
                both > alone + chance,
                format!("{both:.0} % instead of {alone:.0} %"),
            ),
            Row::ours_alone(
                format!("({name}) mean right of the echo"),
                "hits",
                Number::new(mean, 2).with_error((variance / n).sqrt()),
            ),
        ]
    }
}
