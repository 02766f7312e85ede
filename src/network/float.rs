//! The network in double precision, which the fixed-point datapath approximates.

use crate::firmware::depth_estimator::datapath::Datapath;
use crate::kernel::WordFormat;

use super::weights::{Fixed, Weights};

/// Weights of a network in double precision.
pub type Float = Weights<f64, f64, f64, f64>;

impl Float {
    /// Converts fixed-point weights to double precision.
    pub fn from_fixed(fixed: &Fixed, datapath: &Datapath) -> Float {
        let of = |format: WordFormat| move |word: i32| f64::from(word) * format.lsb();
        let Datapath { w1, b1, w2, b2, .. } = *datapath;
        fixed.map(of(w1), of(b1), of(w2), of(b2))
    }

    /// Computes the depth of a histogram [m].
    pub fn forward(&self, histogram: &[u32]) -> f64 {
        self.pass(histogram, libm::tanh, |_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{Network, unrounded::Unrounded};

    #[test]
    fn one_bin_and_one_neuron_by_hand() {
        let mut w1 = vec![vec![0.0; 256]; 8];
        w1[3][7] = 0.001;
        let (mut b1, mut w2) = (vec![0.0; 8], vec![0.0; 8]);
        (b1[3], w2[3]) = (-0.5, 0.25);
        let float = Float { w1, b1, w2, b2: 0.3 };
        let mut histogram = vec![0; 256];
        histogram[7] = 1500;
        assert!((float.forward(&histogram) - (0.25 * 1f64.tanh() + 0.3)).abs() < 1e-15);
    }

    #[test]
    fn without_float_weights_the_twin_has_the_integers_values() {
        let mut network = Network::builtin("ideal").unwrap().unwrap();
        network.float = Unrounded::Unknown;
        let (twin, fixed) = (network.twin(), &network.fixed);
        assert_eq!(twin.b2, f64::from(fixed.b2) / 131_072.0);
        assert_eq!(twin.w1[0][0], f64::from(fixed.w1[0][0]) / 8_388_608.0);
    }
}
