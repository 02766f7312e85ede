//! From the optimiser's parameters to the network's weights: raw counts in, metres out.

use tofsim::network::float::Float;

use super::features::Scaling;

/// The weights of parameters `x`, with the scaling of the inputs taken into them.
pub fn fold(x: &[f64], neurons: usize, scaling: &Scaling) -> Float {
    let columns = scaling.columns();
    let rows = || x.chunks_exact(columns).take(neurons);
    let raw = |row: &[f64]| -> Vec<f64> {
        row.iter().zip(&scaling.inverse_scale).map(|(weight, scale)| weight * scale).collect()
    };
    let bias = |row: &[f64]| {
        let centre = raw(row).iter().zip(&scaling.centre).map(|(w, at)| w * at).sum::<f64>();
        row[columns - 1] - centre
    };
    let (output, basis) = (&x[neurons * columns..], scaling.basis());
    Float {
        w1: rows().map(|row| basis.expand(&raw(row))).collect(),
        b1: rows().map(bias).collect(),
        w2: output[..neurons].to_vec(),
        b2: output[neurons],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::basis::{Echoes, knots_for};
    use tofsim::network::Histogram;

    /// Parameters of a plausible network, and the scaling of its inputs.
    fn parameters() -> (Vec<f64>, Scaling) {
        let knots = knots_for(&Echoes { places: [13.0, 240.0], sigma: 5.48 }, 256, Some(87));
        let columns = knots.len() + 1;
        let mut x: Vec<f64> = (0..8 * columns).map(|k| (k as f64 * 0.37).sin() * 0.05).collect();
        x.extend((0..8).map(|k| 0.1 * (k as f64 - 3.5)));
        x.push(0.2);
        let centre = (0..knots.len()).map(|k| 50.0 + k as f64).collect();
        let inverse_scale = vec![0.02; knots.len()];
        (x, Scaling { centre, inverse_scale, knots, ..Scaling::default() })
    }

    fn histogram(seed: usize) -> Histogram {
        (0..256).map(|bin| ((bin * 31 + seed * 77) % 150) as u32).collect()
    }

    #[test]
    fn folding_changes_no_depth() {
        let (x, scaling) = parameters();
        let (folded, columns) = (fold(&x, 8, &scaling), scaling.columns());
        for seed in 0..20 {
            let inputs = scaling.apply(&histogram(seed));
            let hidden = |row: &[f64]| {
                let products = row.iter().zip(&inputs).map(|(w, x)| w * f64::from(*x));
                libm::tanh(products.sum())
            };
            let hidden = x.chunks_exact(columns).take(8).map(hidden);
            let output = &x[8 * columns..];
            let depth = hidden.zip(output).map(|(a, w)| a * w).sum::<f64>() + output[8];
            assert!((folded.forward(&histogram(seed)) - depth).abs() < 1e-6);
        }
    }
}
