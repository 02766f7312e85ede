//! The network as an estimator: as the firmware has it, and before rounding.

use tofsim::firmware::histogram_builder::Params;
use tofsim::network::{Network, estimate};

use super::estimator::{Estimator, Failure, hits};

/// A network's pass as an estimator; it answers to an empty histogram too.
pub struct NetworkEstimator<P> {
    name: &'static str,
    /// Most hits that its words bear [hits].
    most: u32,
    depth_m: P,
}

impl<P: Fn(&[u32]) -> f64 + Send + Sync> NetworkEstimator<P> {
    /// By the pass, which gives metres, for such histograms.
    pub fn new(name: &'static str, size: &Params, depth_m: P) -> Self {
        NetworkEstimator { name, most: size.most_hits() as u32, depth_m }
    }
}

impl<P: Fn(&[u32]) -> f64 + Send + Sync> Estimator for NetworkEstimator<P> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        match hits(histogram, self.most) {
            Err(failure @ Failure::TooManyHits { .. }) => Err(failure),
            _ => Ok((self.depth_m)(histogram)),
        }
    }
}

/// The network in fixed point, bit for bit as the firmware.
pub fn fixed(network: &Network, size: &Params) -> impl Estimator + use<> {
    let params = network.params(size);
    NetworkEstimator::new("network", size, move |histogram: &[u32]| {
        estimate(&params, histogram).depth.to_f64()
    })
}

/// The network in double precision: its weights before rounding, or else the values of its integers.
pub fn float(network: &Network, size: &Params) -> impl Estimator + use<> {
    let weights = network.twin();
    NetworkEstimator::new("network-float", size, move |histogram: &[u32]| {
        weights.forward(histogram)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_give_the_depth_of_their_pass() {
        let network = Network::builtin("ideal").unwrap().unwrap();
        let mut histogram = [20; 256];
        histogram[100..130].fill(300);
        let expected = estimate(&network.params(&Params::default()), &histogram).depth.to_f64();
        assert_eq!(fixed(&network, &Params::default()).estimate(&histogram), Ok(expected));
        let expected = network.twin().forward(&histogram);
        assert_eq!(float(&network, &Params::default()).estimate(&histogram), Ok(expected));
    }

    #[test]
    fn more_hits_than_the_words_bear_are_refused() {
        let network = Network::builtin("ideal").unwrap().unwrap();
        let failure = Failure::TooManyHits { hits: 65_536, most: 65_535 };
        assert_eq!(fixed(&network, &Params::default()).estimate(&[256; 256]), Err(failure));
        assert_eq!(float(&network, &Params::default()).estimate(&[256; 256]), Err(failure));
        assert!(fixed(&network, &Params::default()).estimate(&[0; 256]).is_ok());
    }
}
