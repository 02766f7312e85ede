//! The network as an estimator: as the firmware has it, and before rounding.

use tofsim::firmware::depth_estimator::Params;
use tofsim::network::float::Float;
use tofsim::network::{Histogram, MAX_HITS, Network, estimate};

use super::{Estimator, Failure};

/// The network in fixed point, bit for bit as the firmware; it answers to an empty histogram too.
#[derive(Clone, Debug)]
pub struct FixedNetwork {
    params: Params,
}

impl FixedNetwork {
    /// Of a network file.
    pub fn new(network: &Network) -> Self {
        FixedNetwork { params: network.params() }
    }
}

impl Estimator for FixedNetwork {
    fn name(&self) -> &'static str {
        "network"
    }

    fn estimate(&self, histogram: &Histogram) -> Result<f64, Failure> {
        bearable(histogram)?;
        Ok(estimate(&self.params, histogram).depth.to_f64())
    }
}

/// The network in double precision; it answers to an empty histogram too.
#[derive(Clone, Debug)]
pub struct FloatNetwork {
    weights: Float,
}

impl FloatNetwork {
    /// Of a network file: its weights before rounding, or else the values of its integers.
    pub fn new(network: &Network) -> Self {
        FloatNetwork { weights: network.twin() }
    }
}

impl Estimator for FloatNetwork {
    fn name(&self) -> &'static str {
        "network-float"
    }

    fn estimate(&self, histogram: &Histogram) -> Result<f64, Failure> {
        bearable(histogram)?;
        Ok(self.weights.forward(histogram))
    }
}

/// Fails for more hits than the datapath's words bear.
fn bearable(histogram: &Histogram) -> Result<(), Failure> {
    match super::hits(histogram, MAX_HITS) {
        Ok(_) | Err(Failure::NoHits) => Ok(()),
        Err(failure) => Err(failure),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_give_the_depth_of_their_pass() {
        let network = Network::builtin("ideal").unwrap().unwrap();
        let mut histogram = [20; 256];
        histogram[100..130].fill(300);
        let fixed = estimate(&network.params(), &histogram).depth.to_f64();
        assert_eq!(FixedNetwork::new(&network).estimate(&histogram), Ok(fixed));
        let float = network.twin().forward(&histogram);
        assert_eq!(FloatNetwork::new(&network).estimate(&histogram), Ok(float));
    }

    #[test]
    fn more_hits_than_the_words_bear_are_refused() {
        let network = Network::builtin("ideal").unwrap().unwrap();
        let failure = Failure::TooManyHits { hits: 65_536, most: 65_535 };
        assert_eq!(FixedNetwork::new(&network).estimate(&[256; 256]), Err(failure));
        assert_eq!(FloatNetwork::new(&network).estimate(&[256; 256]), Err(failure));
        assert!(FixedNetwork::new(&network).estimate(&[0; 256]).is_ok());
    }
}
