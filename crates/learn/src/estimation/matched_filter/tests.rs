use tofsim::firmware::carry_chain::{Delays, TAPS};
use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::kernel::pulse::Pulse;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};

use super::*;

fn even(tap_fs: i64, offset_ps: u64) -> Bins {
    let delays = Delays::new(Time::from_fs(offset_ps * 1000), &[tap_fs; TAPS]).unwrap();
    Bins::of_tdc(&tdc::Params::of_chain(delays))
}

fn filter(bins: &Bins) -> MatchedFilter {
    MatchedFilter::new(&Acquisition::new(bins, 60_000, &Pulse::Gaussian { sigma_ps: 137.0 }))
        .unwrap()
}

#[test]
fn an_expected_histogram_gives_its_scene_between_the_grids_places() {
    for bins in [even(12_500, 2_000), even(11_500, 2_230)] {
        for (arrival_ps, signal, rate_hz) in
            [(3341.0, 0.9, 4e8), (2000.0, 2.0, 0.0), (4009.0, 0.14, 9e8)]
        {
            let budget = Budget {
                signal_per_shot: signal,
                ambient_rate_hz: rate_hz,
                mean_arrival: Time::from_ps_f64(arrival_ps),
                ..Budget::default()
            };
            let probabilities = BinProbabilities::new(&Hazard::new(&budget), &bins);
            let histogram = probabilities.of_code().iter();
            let histogram: Vec<_> = histogram.map(|p| (p * 60_000.0).round() as u32).collect();
            let found = filter(&bins).best(&histogram).unwrap();
            assert!((found.echo.arrival_ps - arrival_ps).abs() < 1.0, "{found:?}");
            assert!((found.echo.signal / signal - 1.0).abs() < 0.02, "{found:?}");
            let error = found.echo.background_per_ps - rate_hz * 1e-12;
            assert!(error.abs() < 4e-6, "{found:?}");
            assert!(found.significance > 5.0, "{found:?}");
        }
    }
}

#[test]
fn a_flat_hazard_and_single_hits_are_no_echo() {
    let filter = filter(&even(12_500, 2_000));
    assert_eq!(filter.estimate(&[0; 256]), Err(Failure::NoHits));
    let flat = |bin| (600.0 * (-0.01 * f64::from(bin)).exp()).round() as u32;
    let flat: Vec<_> = (0..256).map(flat).collect();
    assert_eq!(filter.estimate(&flat), Err(Failure::NoPeak));
    let mut few = [0; 256];
    (few[100], few[103]) = (2, 1);
    assert_eq!(filter.estimate(&few), Err(Failure::NoPeak));
}

#[test]
fn a_code_that_no_time_gives_is_not_missed() {
    let bins = even(40_000, 2_000);
    let filter = filter(&bins);
    assert!(filter.codes.len() < 256);
    assert!((filter.widths.iter().sum::<f64>() - 1.0).abs() < 1e-12);
}
