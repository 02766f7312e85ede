//! A network in a datapath: its depths, and what saturates.

use std::sync::atomic::{AtomicU64, Ordering};

use tofsim::error::Result;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::network::float::Float;
use tofsim::network::formats::{Overflow, WordFormat};
use tofsim::network::{Histogram, MAX_HITS};

use super::Datapath;

/// A network in a datapath.
#[derive(Debug)]
pub struct Circuit {
    datapath: Datapath,
    w1: Vec<[i64; BINS]>,
    b1: Vec<i64>,
    w2: Vec<i64>,
    b2: i64,
    table: Vec<i64>,
    /// Weights that no word holds, and were saturated.
    pub saturated_weights: usize,
    /// Sums that lay past the table, of all histograms seen.
    saturated_sums: AtomicU64,
}

impl Circuit {
    /// Rounds the weights, halves away from zero; what no word holds is saturated.
    ///
    /// # Errors
    /// When [`Datapath::check`] fails.
    pub fn new(float: &Float, datapath: Datapath) -> Result<Self> {
        datapath.check()?;
        let mut saturated_weights = 0;
        let mut word = |format: WordFormat, value: f64| {
            let fits = format.round(value, Overflow::Refuse);
            saturated_weights += usize::from(fits.is_none());
            fits.or_else(|| format.round(value, Overflow::Saturate)).unwrap_or_default()
        };
        let w1 = float.w1.iter().map(|row| row.map(|weight| word(datapath.w1, weight))).collect();
        let b1: Vec<i64> = float.b1.iter().map(|&bias| word(datapath.b1, bias)).collect();
        let w2 = float.w2.iter().map(|&weight| word(datapath.w2, weight)).collect();
        let b2 = word(datapath.b2, float.b2);
        let (entries, half) = (1i64 << datapath.address_bits, 1i64 << (datapath.address_bits - 1));
        let step = f64::from(1u32 << datapath.range_log2) / half as f64;
        let entry = |place: i64| {
            let value = libm::tanh((place - half) as f64 * step);
            datapath.l1_out.round(value, Overflow::Saturate).unwrap_or_default()
        };
        Ok(Circuit {
            datapath,
            w1,
            b1: b1
                .iter()
                .map(|bias| bias << (datapath.w1.fraction - datapath.b1.fraction))
                .collect(),
            w2,
            b2: b2 << (datapath.w2.fraction + datapath.l1_out.fraction - datapath.b2.fraction),
            table: (0..entries).map(entry).collect(),
            saturated_weights,
            saturated_sums: AtomicU64::new(0),
        })
    }

    /// Depth of a histogram [m].
    pub fn depth_m(&self, histogram: &Histogram) -> f64 {
        let (shift, half) = (self.datapath.shift(), self.table.len() as i64 / 2);
        let (mut depth, mut saturated) = (self.b2, 0);
        for neuron in 0..self.w2.len() {
            let products = self.w1[neuron].iter().zip(histogram);
            let products = products.map(|(weight, &count)| weight * i64::from(count));
            let sum = products.sum::<i64>() + self.b1[neuron];
            let rounded = (sum + (1 << (shift - 1))) >> shift;
            let address = rounded.clamp(-half, half - 1);
            saturated += u64::from(address != rounded);
            depth += self.table[(address + half) as usize] * self.w2[neuron];
        }
        self.saturated_sums.fetch_add(saturated, Ordering::Relaxed);
        let fraction = self.datapath.w2.fraction + self.datapath.l1_out.fraction;
        depth as f64 * (-f64::from(fraction)).exp2()
    }

    /// Sums that lay past the table, of all histograms seen.
    pub fn saturated_sums(&self) -> u64 {
        self.saturated_sums.load(Ordering::Relaxed)
    }

    /// Bits, with sign, that no sum of a legal histogram exceeds: of the hidden layer and the depth.
    pub fn sum_bits(&self) -> [u32; 2] {
        let largest = |row: &[i64; BINS]| row.iter().map(|weight| weight.abs()).max().unwrap_or(0);
        let hidden = self.w1.iter().zip(&self.b1);
        let hidden = hidden.map(|(row, bias)| i64::from(MAX_HITS) * largest(row) + bias.abs());
        let one = self.datapath.l1_out.min().abs();
        let depth = self.w2.iter().map(|weight| weight.abs() * one).sum::<i64>() + self.b2.abs();
        [hidden.max().unwrap_or(0), depth].map(|most| i64::BITS - most.leading_zeros() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::network::{Network, estimate};

    fn peak(bin: usize, height: u16) -> Histogram {
        std::array::from_fn(|k| height / (1 + k.abs_diff(bin) as u16))
    }

    #[test]
    fn the_firmware_s_formats_give_what_the_firmware_gives() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            let circuit = Circuit::new(&network.twin(), Datapath::default()).unwrap();
            for bin in (5..250).step_by(7) {
                let histogram = peak(bin, 200 + 20 * bin as u16);
                let expected = estimate(&network.params(), &histogram).depth.to_f64();
                assert_eq!(circuit.depth_m(&histogram), expected);
            }
            assert_eq!(circuit.saturated_weights, 0);
            let [hidden, depth] = circuit.sum_bits();
            assert!(hidden <= 36 && depth <= 36, "{hidden} {depth}");
        }
    }

    #[test]
    fn longer_words_come_nearer_to_float() {
        let float = Network::builtin("uniform").unwrap().unwrap().twin();
        let error = |address_bits| {
            let datapath = Datapath { address_bits, range_log2: 3, ..Datapath::default() };
            let circuit = Circuit::new(&float, datapath).unwrap();
            let errors = (5..250).map(|bin| {
                let histogram = peak(bin, 3000);
                (circuit.depth_m(&histogram) - float.forward(&histogram)).powi(2)
            });
            errors.sum::<f64>().sqrt()
        };
        assert!(error(8) > 2.0 * error(10) && error(10) > 2.0 * error(12));
    }
}
