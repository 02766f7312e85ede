//! Histograms that no light makes.

use proptest::prelude::*;

use tofsim::Setup;
use tofsim::network::Histogram;
use tofsim_learn::estimation::peak_detection::PeakDetection;
use tofsim_learn::estimation::subtraction::Subtraction;
use tofsim_learn::estimation::{Acquisition, EstimatorInputs, EstimatorKind};
use tofsim_learn::estimation::{Estimator, Failure, HistogramPair};

use super::{acquisition, bins};

fn any_histogram() -> impl Strategy<Value = Histogram> {
    let counts = prop_oneof![
        prop::collection::vec(0u32..65_536, 256),
        prop::collection::vec(0u32..200, 256),
        prop::collection::vec(prop_oneof![9 => Just(0u32), 1 => 0u32..3000], 256),
        (0u32..65_536).prop_map(|count| vec![count; 256]),
        (0..256usize, 0u32..65_536, 0u32..80).prop_map(|(bin, count, floor)| {
            let mut counts = vec![floor; 256];
            counts[bin] = count;
            counts
        }),
    ];
    counts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_histogram_makes_an_estimator_panic_or_answer_with_nonsense(
        histogram in any_histogram(),
        profile in prop::sample::select(vec!["ideal", "uniform", "table6_3"]),
        shots in prop::sample::select(vec![1u64, 500, 30_000, 65_535]),
    ) {
        let setup = &Setup::load("kc705", &[&format!("tdc.profile={profile}")]).unwrap();
        let bins = bins(profile);
        let acquisition = Acquisition { shots, ..acquisition(&bins) };
        let needs = EstimatorInputs { acquisition, network: &setup.network, setup };
        for &(_, kind, _) in EstimatorKind::ALL {
            if kind == EstimatorKind::Subtraction {
                continue;
            }
            match kind.estimator(&needs).unwrap().estimate(&histogram) {
                Ok(distance_m) => prop_assert!(distance_m.abs() < 50.0, "{kind:?} {distance_m}"),
                Err(failure) => prop_assert!(!failure.to_string().is_empty()),
            }
        }
        let subtraction = Subtraction { detection: PeakDetection::new(shots) };
        let found = subtraction.estimate_pair(&HistogramPair { dark: vec![200; 256], lit: histogram });
        prop_assert!(found.is_err() || found.is_ok_and(f64::is_finite));
    }
}

#[test]
fn an_empty_histogram_has_no_distance() {
    let (bins, setup) = (bins("uniform"), &Setup::load("kc705", &[]).unwrap());
    let needs = EstimatorInputs { acquisition: acquisition(&bins), network: &setup.network, setup };
    for kind in [EstimatorKind::Peak, EstimatorKind::Likelihood, EstimatorKind::Matched] {
        assert_eq!(kind.estimator(&needs).unwrap().estimate(&[0; 256]), Err(Failure::NoHits));
    }
}
