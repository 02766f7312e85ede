//! Expected causes of the hits with each code, for histograms whose avalanches were not simulated.

use super::closed_form::Bins;
use super::hazard::{BY_CAUSE, Hazard};

/// Returns the fractions of each code's hits that are due to each of [`BY_CAUSE`], if the first avalanche of a shot
/// decides. All are zero for a code without hits [1].
pub fn cause_parts(hazard: &Hazard, bins: &Bins) -> Vec<[f64; BY_CAUSE.len()]> {
    let mut parts = vec![[0.0; BY_CAUSE.len()]; bins.count()];
    for span in bins.spans() {
        // Within a span, which is a few taps, the chance that nothing came before hardly changes.
        let before = (-hazard.at(span.from)).exp();
        let added = hazard.by_cause(span.from, span.until);
        let code = &mut parts[span.code as usize];
        code.iter_mut().zip(added).for_each(|(part, added)| *part += before * added);
    }
    for code in &mut parts {
        let all: f64 = code.iter().sum();
        code.iter_mut().for_each(|part| *part = if all > 0.0 { *part / all } else { 0.0 });
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Observers, Run, Setup, Shot};

    #[test]
    fn they_are_those_of_a_run() {
        let glass = ["spad.dark_rate_hz=2e8", "cover.fraction=4e-5", "cover.delay_ps=2800"];
        let smeared = [&glass[..], &["cover.smear_fraction=0.3"]].concat();
        for keys in [&glass[..1], &smeared] {
            check(&Setup::load("kc705", keys).unwrap());
        }
    }

    /// Compares them with those of a run.
    fn check(setup: &Setup) {
        let mut counts = vec![[0u32; BY_CAUSE.len()]; 256];
        let mut take = |shot: &Shot| {
            let cause = BY_CAUSE.iter().position(|cause| Some(*cause) == shot.cause);
            if let (Some(code), Some(cause)) = (shot.code, cause) {
                counts[code as usize][cause] += 1;
            }
            Ok(())
        };
        let observers = Observers { shots: Some(&mut take), ..Observers::default() };
        Run::new(setup).observe(1, observers).unwrap();
        let parts = cause_parts(&Hazard::new(&setup.budget), &setup.bins());
        let (mut square, mut degrees) = (0.0, 0.0);
        for (counts, parts) in counts.iter().zip(&parts) {
            let all: u32 = counts.iter().sum();
            for (count, part) in counts.iter().zip(parts) {
                let expected = f64::from(all) * part;
                if expected > 5.0 {
                    square += (f64::from(*count) - expected).powi(2) / expected;
                    degrees += 1.0;
                }
            }
        }
        // A third of the terms is decided by the sums.
        assert!(degrees > 300.0 && square < 0.9 * degrees, "{square} of {degrees}");
    }
}
