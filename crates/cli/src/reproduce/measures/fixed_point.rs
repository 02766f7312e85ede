//! Words in fixed point: Table 6.4 and Fig. 6.16.

use tofsim::error::Result;
use tofsim::network::float::Float;

use crate::page::plot::{BLUE, Layer, ORANGE, Shape};
use crate::reproduce::study::Study;
use crate::reproduce::values::{Measured, Values};

pub(super) fn formats(study: &Study) -> Result<Measured> {
    let setup = study.ideal()?;
    let mut values = Values::of(&setup.network.datapath);
    values.put("count_bits", f64::from(setup.params.histogram.count_bits));
    Ok(values.into())
}

/// Relative differences of the rounded from the exact, number by number, where the exact is not 0 [%].
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

pub(super) fn weights(study: &Study) -> Result<Measured> {
    let network = study.ideal()?.network;
    let rounded = Float::from_fixed(&network.fixed, &network.datapath);
    let mut found = differences(&network.twin(), &rounded);
    let drawn = found.iter().enumerate().map(|(k, percent)| (k as f64, percent.max(1e-6).log10()));
    let layers = vec![Layer::new("", BLUE, Shape::Dots, drawn)];
    found.sort_by(f64::total_cmp);
    let at = |part: f64| {
        found.get((part * (found.len().max(1) - 1) as f64) as usize).copied().unwrap_or(f64::NAN)
    };
    let mut values = Values::default();
    values.put("numbers", found.len() as f64);
    values.put("median", at(0.5));
    values.put("percentile_99", at(0.99));
    values.put("largest", at(1.0));
    Ok(Measured::from(values).layers(layers))
}

pub(super) fn activation(study: &Study) -> Result<Measured> {
    let path = study.ideal()?.network.datapath;
    let (table, bits, lsb) = (path.table(), path.address_bits, path.l1_out.lsb());
    let half = 1i64 << (bits - 1);
    let of = |address: i64| {
        let entry = table[(address & (2 * half - 1)) as usize] as f64 * lsb;
        let sum = address as f64 * path.step();
        (sum, entry)
    };
    let addresses = || (-half..half).map(of);
    let largest = |differences: &mut dyn Iterator<Item = f64>| differences.fold(0.0, f64::max);
    // Within a step of the table the sum may be anything.
    let mut anywhere = addresses().flat_map(|(sum, entry)| {
        let ends = [sum - path.step() / 2.0, sum + path.step() / 2.0];
        ends.map(|end| (entry - end.tanh()).abs())
    });
    let mut values = Values::default();
    values.put("entries", table.len() as f64);
    values.put("anywhere", largest(&mut anywhere));
    let mut at_points = addresses().map(|(sum, entry)| (entry - sum.tanh()).abs());
    values.put("at_points", largest(&mut at_points));
    values.put("past_the_end", 1.0 - 4f64.tanh());
    let drawn = addresses().step_by(8).map(|(sum, entry)| (sum, 1e6 * (entry - sum.tanh())));
    let layers = vec![Layer::new("entry less tanh, at the points", ORANGE, Shape::Line, drawn)];
    Ok(Measured::from(values).layers(layers))
}
