//! The estimator of a variant: configured for the variant's histograms, with its own effects on or off.

use tofsim::error::Result;
use tofsim::firmware::centroid_estimator::Params as CentroidParams;
use tofsim::firmware::depth_estimator::Params as NetworkParams;
use tofsim::firmware::forward1::L1In;
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::network::float::Float;
use tofsim::sim::estimates::centroid::locate;

use crate::estimation::estimator::{Failure, FromFn};
use crate::estimation::in_firmware::likelihood_estimator;
use crate::estimation::network::of_pass;
use crate::estimation::{Acquisition, Estimator, EstimatorInputs, EstimatorKind};
use crate::quantize::likelihood::LikelihoodExplainer;

use super::effect::Effect;
use super::variant::Variant;

/// Creates the estimator of a kind, configured for a variant.
///
/// # Errors
/// When its model is invalid for the variant.
pub fn estimator(kind: EstimatorKind, variant: &Variant) -> Result<Box<dyn Estimator>> {
    let Variant { effects, setup, assumed_bins: bins, assumed_shots, .. } = variant;
    let is_fixed = effects.has(Effect::FixedPoint);
    kind.check(setup)?;
    Ok(match kind {
        EstimatorKind::Network if !(is_fixed && effects.has(Effect::Table)) => {
            network(variant, is_fixed, effects.has(Effect::Table))
        }
        EstimatorKind::LikelihoodEstimator if is_fixed => {
            let params = setup.likelihood_of(*assumed_shots, bins, Params::new)?;
            Box::new(likelihood_estimator(params))
        }
        EstimatorKind::LikelihoodEstimator => {
            let explainer = LikelihoodExplainer::of_bins(setup, *assumed_shots, bins)?;
            let estimate = move |histogram: &[u32]| match explainer.float(histogram) {
                (depth_m, status) if status.is_empty() => Ok(depth_m),
                (_, status) => Err(Failure::Rejected(status)),
            };
            Box::new(FromFn { name: kind.name(), estimate })
        }
        EstimatorKind::Centroid if !is_fixed => {
            let params = setup.params.estimators.centroid_estimator.clone();
            let estimate = move |histogram: &[u32]| centroid_m(&params, histogram);
            Box::new(FromFn { name: kind.name(), estimate })
        }
        kind => {
            // The threshold of peak detection is a part of the shots that there are.
            let shots = if kind == EstimatorKind::Peak { setup.shots(1) } else { *assumed_shots };
            let acquisition = Acquisition { shots, ..variant.acquisition() };
            kind.estimator(&EstimatorInputs { acquisition, network: &setup.network, setup })?
        }
    })
}

/// The network with its weights rounded or not, and with its table or the exact hyperbolic tangent.
fn network(variant: &Variant, is_rounded: bool, has_table: bool) -> Box<dyn Estimator> {
    let (network, size) = (&variant.setup.network, &variant.setup.params.histogram);
    let weights = if is_rounded {
        Float::from_fixed(&network.fixed, &network.datapath)
    } else {
        network.twin()
    };
    let params = network.params(size);
    let depth_m = move |histogram: &[u32]| {
        if has_table {
            weights.pass(histogram, |sum| looked_up(&params, sum), |_| ())
        } else {
            weights.forward(histogram)
        }
    };
    Box::new(of_pass("network", size, depth_m))
}

/// Looks up a sum in the activation table [1].
fn looked_up(params: &NetworkParams, sum: f64) -> f64 {
    let datapath = &params.forward2.datapath;
    // Beyond the table's range it has its last entry, so the largest sums need not be exact.
    let word = (sum / datapath.w1.lsb()).round().clamp(-3e10, 3e10) as i64;
    params.tansig.activation(L1In::new(word)).get() as f64 * datapath.l1_out.lsb()
}

/// Distance by the centroid in double precision [m].
fn centroid_m(p: &CentroidParams, histogram: &[u32]) -> std::result::Result<f64, Failure> {
    let found = locate(p, histogram);
    if found.best == 0 {
        return Err(Failure::NoPeak);
    }
    let half_width = p.half_width as usize;
    let window = histogram.iter().enumerate().take(found.peak + half_width + 1);
    let window = window.skip(found.peak.saturating_sub(half_width));
    let sum: f64 = window.map(|(bin, &count)| f64::from(count) * (bin as f64 + 0.5)).sum();
    let (bin_m, offset_m): (f64, f64) = (p.slope_m().to_num(), p.offset_m().to_num());
    Ok(sum / found.best_sum as f64 * bin_m + offset_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error_budget::effect::EffectSet;
    use tofsim::scenario;

    /// Returns the depths of an estimator for a frame of kc705 with some effects off [m].
    fn depths(kind: EstimatorKind, off: &[&[Effect]]) -> Vec<f64> {
        let loaded = scenario::load("kc705", &[]).unwrap();
        let all = EffectSet::of(Effect::ALL);
        let histogram = Variant::new(&loaded, all).unwrap().histograms().drawn(1, 0);
        let depth = |off: &&[Effect]| {
            let effects = off.iter().fold(all, |all, &effect| all.without(effect));
            let variant = Variant::new(&loaded, effects).unwrap();
            estimator(kind, &variant).unwrap().estimate(&histogram).unwrap()
        };
        off.iter().map(depth).collect()
    }

    #[test]
    fn a_network_with_neither_words_nor_table_is_the_one_in_double_precision() {
        let both = [Effect::FixedPoint, Effect::Table];
        let off: [&[Effect]; 4] = [&[], &both[..1], &both[1..], &both];
        let found = depths(EstimatorKind::Network, &off);
        assert_eq!(found[3], depths(EstimatorKind::NetworkFloat, &[&[]])[0]);
        // Each rounding moves it, and both of them as far as one after the other, but for the rounding of a sum.
        let [fixed, table, words, float] = found[..] else { panic!("four depths") };
        assert!(words != float && table != float);
        let together = (words - float) + (table - float);
        assert!((fixed - float - together).abs() < 2e-4, "{found:?}");
        assert!((fixed - float).abs() < 1.2e-3, "{found:?}");
    }

    #[test]
    fn twins_in_double_precision_are_near_the_words() {
        for (kind, most_m) in
            [(EstimatorKind::Centroid, 2e-6), (EstimatorKind::LikelihoodEstimator, 1e-4)]
        {
            let found = depths(kind, &[&[], &[Effect::FixedPoint]]);
            let off = (found[0] - found[1]).abs();
            assert!(off > 0.0 && off < most_m, "{kind:?}: {found:?}");
        }
    }
}
