//! Where a frame's hits lie around the echo.

use tofsim::optics::first_photon::{FirstPhoton, around_the_echo};
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;

use crate::figure::{Figure, mean};

/// The bins around the echo, and the mean of the hits in them, frame by frame.
#[derive(Clone, Debug, Default)]
pub struct EchoShift {
    /// Code, and how far its middle lies from the light's mean arrival [bins, mm].
    bins: Vec<(usize, f64)>,
    /// The mean of each frame that has hits there [mm].
    means: Vec<f64>,
}

impl EchoShift {
    /// Of a setup's frames, none of which was seen yet.
    pub fn new(setup: &Setup) -> Self {
        let around = around_the_echo(&setup.budget);
        let arrival_ps = setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let bins = setup.bins();
        let spans = bins.spans().iter().map(|span| {
            let middle = (span.from.fs() + span.until.fs()) / 2;
            (usize::from(span.code), middle)
        });
        let within =
            |&(_, middle): &(usize, u64)| (around[0].fs()..around[1].fs()).contains(&middle);
        let shift = |(code, middle): (usize, u64)| {
            (code, FirstPhoton::shift_mm(middle as f64 * 1e-3 - arrival_ps))
        };
        EchoShift { bins: spans.filter(within).map(shift).collect(), means: Vec::new() }
    }

    /// Takes the next frame.
    pub fn take(&mut self, frame: &Frame) {
        let (mut hits, mut sum) = (0.0, 0.0);
        for &(code, mm) in &self.bins {
            let count = f64::from(frame.histogram[code]);
            hits += count;
            sum += count * mm;
        }
        if hits > 0.0 {
            self.means.push(sum / hits);
        }
    }

    /// The mean over frames [mm].
    pub fn mean(&self) -> Figure {
        mean(self.means.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use tofsim::Run;

    use super::*;

    #[test]
    fn hits_lie_where_the_first_photon_model_puts_them() {
        for (reflectance, irradiance) in [(0.05, 0.0), (0.6, 0.0), (0.6, 0.4)] {
            let set = [
                "tdc.profile=ideal".to_owned(),
                "target.distance_m=0.2".to_owned(),
                format!("target.reflectance={reflectance}"),
                format!("ambient.irradiance_w_m2_nm={irradiance}"),
            ];
            let set: Vec<_> = set.iter().map(String::as_str).collect();
            let setup = Setup::load("kc705", &set).unwrap();
            let mut echo = EchoShift::new(&setup);
            let run = Run::new(&setup).stepping(tofsim::Stepping::LeapShots);
            run.frames(8).unwrap().iter().for_each(|frame| echo.take(frame));
            let Figure { value: Some(found), se: Some(se) } = echo.mean() else { panic!() };
            let hazard = tofsim::optics::Hazard::new(&setup.budget);
            let first = FirstPhoton::new(&setup.budget, &hazard).unwrap();
            let expected = FirstPhoton::shift_mm(first.mean_ps);
            // The window's ends cut bins.
            assert!((found - expected).abs() < 0.1 + 4.0 * se, "{found} +-{se} for {expected}");
        }
    }
}
