//! Expected counts of a shot in closed form, including jitter of the clocks.

use tofsim::kernel::Time;
use tofsim::optics::{Bins, Hazard};

/// Range of a mean over jitter, on either side [standard deviations].
const REACH: i32 = 6;
/// Its steps to a standard deviation.
const STEPS: i32 = 4;

/// Mean number of hits with each code in one shot that is armed at the laser edge: of its first avalanche. Jitter moves the edge that samples a hit against the laser's, by a
/// standard deviation of `jitter_ps`; the trapezoidal rule over six of them errs by less than 1e-10. What jitter does
/// within a few deviations of the laser edge, and of where the coarse count changes, is left out: there the diode is
/// armed early or late, and a hit may go to the next edge, which has jitter of its own [1].
pub fn per_shot(hazard: &Hazard, bins: &Bins, jitter_ps: f64) -> Vec<f64> {
    let mut of_code = vec![0.0; bins.count()];
    for (late_fs, weight) in normal_fs(jitter_ps) {
        hazard.each(|share, shot| {
            let grown = first_avalanches(&|t| shot.at(t), bins, late_fs);
            of_code.iter_mut().zip(grown).for_each(|(sum, hits)| *sum += weight * share * hits);
        });
    }
    of_code
}

/// Places of a normal distribution and their weights; one place without a deviation [fs, 1].
fn normal_fs(deviation_ps: f64) -> Vec<(f64, f64)> {
    if deviation_ps == 0.0 {
        return vec![(0.0, 1.0)];
    }
    let places = (-REACH * STEPS..=REACH * STEPS).map(|k| f64::from(k) / f64::from(STEPS));
    let weights: Vec<_> = places.map(|z| (z, libm::exp(-0.5 * z * z))).collect();
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    weights.into_iter().map(|(z, weight)| (1e3 * deviation_ps * z, weight / sum)).collect()
}

/// Chance of a first avalanche in each code's times, which come so much later.
fn first_avalanches(hazard: &dyn Fn(Time) -> f64, bins: &Bins, late_fs: f64) -> Vec<f64> {
    let late = |time: Time| Time::from_fs((time.fs() as f64 + late_fs).round().max(0.0) as u64);
    let mut of_code = vec![0.0; bins.count()];
    for span in bins.spans() {
        let [from, until] = [span.from, span.until].map(|time| hazard(late(time)));
        of_code[span.code as usize] -= libm::exp(-from) * libm::expm1(from - until);
    }
    of_code
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::optics::BinProbabilities;
    use tofsim::sim::setup::Setup;

    fn setup(keys: &[&str]) -> Setup {
        Setup::load("kc705", keys).unwrap()
    }

    #[test]
    fn without_jitter_it_is_the_closed_form_of_the_optics() {
        for keys in [&[][..], &["laser.timing_jitter_ps=100", "laser.energy_jitter=0.3"]] {
            let setup = setup(keys);
            let (hazard, bins) = (Hazard::new(&setup.budget), setup.bins());
            let found = per_shot(&hazard, &bins, 0.0);
            for (found, &expected) in
                found.iter().zip(BinProbabilities::new(&hazard, &bins).of_code())
            {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }

    #[test]
    fn jitter_widens_a_faint_echo_as_the_root_of_squares() {
        let setup = setup(&[
            "ambient.irradiance_w_m2_nm=0",
            "spad.dark_rate_hz=0",
            "laser.average_power_w=1e-7",
        ]);
        let deviation = |jitter_ps| {
            let hits = per_shot(&Hazard::new(&setup.budget), &setup.bins(), jitter_ps);
            let moment = |power: i32| {
                let terms =
                    hits.iter().zip(0..).map(|(hits, code)| hits * f64::from(code).powi(power));
                terms.sum::<f64>() / hits.iter().sum::<f64>()
            };
            25.0 * (moment(2) - moment(1).powi(2)).sqrt()
        };
        let expected = (deviation(0.0).powi(2) + 80f64.powi(2)).sqrt();
        assert!((deviation(80.0) / expected - 1.0).abs() < 1e-3, "{}", deviation(80.0));
    }
}
