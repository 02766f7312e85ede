//! The network as an estimator: as the firmware has it, and before rounding.

use tofsim::firmware::histogram_builder::Params;
use tofsim::network::{Network, estimate};

use super::estimator::{Estimator, Failure, FromFn, hits};

/// A network's pass, which gives metres, as an estimator for such histograms; it answers to an empty one too.
pub fn of_pass<P: Fn(&[u32]) -> f64 + Send + Sync>(
    name: &'static str,
    size: &Params,
    depth_m: P,
) -> impl Estimator + use<P> {
    let most = size.most_hits() as u32;
    let estimate = move |histogram: &[u32]| match hits(histogram, most) {
        Err(failure @ Failure::TooManyHits { .. }) => Err(failure),
        _ => Ok(depth_m(histogram)),
    };
    FromFn { name, estimate }
}

/// The network in fixed point, bit for bit as the firmware.
pub fn fixed(network: &Network, size: &Params) -> impl Estimator + use<> {
    let params = network.params(size);
    of_pass("network", size, move |histogram| estimate(&params, histogram).depth.to_f64())
}

/// The network in double precision: its weights before rounding, or else the values of its integers.
pub fn float(network: &Network, size: &Params) -> impl Estimator + use<> {
    let weights = network.twin();
    of_pass("network-float", size, move |histogram| weights.forward(histogram))
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
