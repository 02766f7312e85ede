//! Numbers in fixed point: Table 6.4 and Fig. 6.16.

use tofsim::error::Result;
use tofsim::network::float::Float;

use crate::page::plot::{BLUE, Layer, ORANGE, Plot, Shape};
use crate::reproduce::item::{Finding, Item};
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row, Verdict};

pub const ITEMS: [Item; 3] = [
    Item::made("table-6.4", "Formats of the words", formats),
    Item::made("fig-6.16a", "Weights and biases in fixed and in floating point", weights),
    Item::made("fig-6.16b", "The activation in fixed and in floating point", activation),
];

fn formats(study: &Study) -> Result<Finding> {
    let setup = study.ideal()?;
    let path = setup.network.datapath;
    let word = |width: u32, fraction: u32| format!("1, {width}, {fraction}");
    let of = |name: &str, thesis: &str, format: tofsim::kernel::WordFormat| {
        let what = format!("{name}: sign bit, word length, fraction length");
        Row::words(what, thesis, word(format.width, format.fraction))
    };
    let count = format!("0, {}, 0", setup.params.histogram.count_bits);
    let rows = [
        Row::words("y: sign bit, word length, fraction length", "0, 16, 0", count),
        of("W1", "1, 16, 23", path.w1),
        of("W2", "1, 16, 14", path.w2),
        of("B1", "1, 16, 13", path.b1),
        of("B2", "1, 16, 17", path.b2),
        of("tansig LUT output", "1, 16, 15", path.l1_out),
    ];
    Ok(Finding::of(rows).shown_by("tofsim quantize ideal"))
}

/// Relative differences of the rounded from the exact, number by number, where the exact is not nothing [%].
fn differences(exact: &Float, rounded: &Float) -> Vec<f64> {
    let all = |of: &Float| -> Vec<f64> {
        of.w1.iter().flatten().chain(&of.b1).chain(&of.w2).copied().chain([of.b2]).collect()
    };
    let pairs = all(exact).into_iter().zip(all(rounded));
    pairs
        .filter(|(exact, _)| *exact != 0.0)
        .map(|(exact, rounded)| 100.0 * (rounded / exact - 1.0).abs())
        .collect()
}

const OTHER: &str = "The figure prints no numbers, and the thesis's weights are not published: what is drawn is of the network here.";

fn weights(study: &Study) -> Result<Finding> {
    let network = study.ideal()?.network;
    let rounded = Float::from_fixed(&network.fixed, &network.datapath);
    let mut found = differences(&network.twin(), &rounded);
    let drawn: Vec<_> = found
        .iter()
        .enumerate()
        .map(|(k, percent)| (k as f64, percent.max(1e-6).log10()))
        .collect();
    found.sort_by(f64::total_cmp);
    let at = |part: f64| {
        found.get((part * (found.len().max(1) - 1) as f64) as usize).copied().unwrap_or(f64::NAN)
    };
    let rows = [
        Row::ours_alone("numbers", "", Number::new(found.len() as f64, 0)),
        Row::ours_alone("relative difference, median", "%", Number::new(at(0.5), 4)),
        Row::ours_alone("relative difference, 99 of 100 below", "%", Number::new(at(0.99), 3)),
        Row::ours_alone("relative difference, largest", "%", Number::new(at(1.0), 2)),
    ];
    let layers = vec![Layer::new("", BLUE, Shape::Dots, drawn)];
    let axes = ["number: W1, then B1, W2, B2", "log10 of the relative difference in %"];
    let plot = Plot { title: "Rounding of weights and biases", axes, layers };
    let words = "Small weights differ by most in relation to themselves: a word's last bit is the same for all.";
    let finding = Finding { overruled: Some(Verdict::CannotBeReproduced), ..Finding::of(rows) };
    finding.because(OTHER).with_plot(&plot, words)
}

fn activation(study: &Study) -> Result<Finding> {
    let path = study.ideal()?.network.datapath;
    let (table, bits, lsb) = (path.table(), path.address_bits, path.l1_out.lsb());
    let half = 1i64 << (bits - 1);
    let of = |address: i64| {
        let entry = table[(address & (2 * half - 1)) as usize] as f64 * lsb;
        let sum = address as f64 * path.step();
        (sum, entry)
    };
    let addresses = || (-half..half).map(of);
    // Within a step of the table the sum may be anything.
    let worst = addresses().map(|(sum, entry)| {
        let ends = [sum - path.step() / 2.0, sum + path.step() / 2.0];
        ends.map(|end| (entry - end.tanh()).abs()).into_iter().fold(0.0, f64::max)
    });
    let worst = worst.fold(0.0, f64::max);
    let at_points = addresses().map(|(sum, entry)| (entry - sum.tanh()).abs()).fold(0.0, f64::max);
    let rows = [
        Row::ours_alone("entries", "", Number::new(table.len() as f64, 0)),
        Row::ours_alone(
            "largest difference at the table's own points",
            "",
            Number::new(at_points, 6),
        ),
        Row::ours_alone("largest difference anywhere within it", "", Number::new(worst, 6)),
        Row::ours_alone("difference past its end", "", Number::new(1.0 - 4f64.tanh(), 6)),
    ];
    let layers = vec![Layer::new(
        "entry less tanh, at the points",
        ORANGE,
        Shape::Line,
        addresses().step_by(8).map(|(sum, entry)| (sum, 1e6 * (entry - sum.tanh()))),
    )];
    let axes = ["sum", "difference [1e-6]"];
    let plot = Plot { title: "Table of activations", axes, layers };
    let words = "Entries are rounded to 15 bits; sums are rounded to the table's steps before.";
    let finding = Finding { overruled: Some(Verdict::CannotBeReproduced), ..Finding::of(rows) };
    finding.because(OTHER).with_plot(&plot, words)
}
