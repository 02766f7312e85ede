//! Mean of a frame's hits around the echo.

use tofsim::optics::closed_form::Span;
use tofsim::optics::first_photon::{FirstPhoton, around_the_echo};
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;

use crate::figure::{Figure, mean};

/// Bins around the echo, and the mean time of the hits in them for each frame.
#[derive(Clone, Debug, Default)]
pub struct EchoShift {
    bins: Vec<Bin>,
    /// Mean of each frame that has hits there, as a distance [mm].
    means: Vec<f64>,
}

/// A bin, or the part of it that lies around the echo.
#[derive(Clone, Copy, Debug)]
struct Bin {
    code: usize,
    /// Fraction of the bin that lies there [1].
    part: f64,
    /// Middle of that part, relative to the light's mean arrival [mm].
    shift_mm: f64,
}

impl EchoShift {
    /// Determines the bins of a setup.
    pub fn new(setup: &Setup) -> Self {
        let [begin, end] = around_the_echo(&setup.budget);
        let arrival_ps = setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let bin = |span: &Span| {
            let [from, until] =
                [span.from.max(begin), span.until.min(end)].map(|time| time.fs() as f64);
            let width = (span.until - span.from).fs() as f64;
            let shift_mm = FirstPhoton::shift_mm((from + until) / 2.0 * 1e-3 - arrival_ps);
            let bin = Bin { code: span.code.into(), part: (until - from) / width, shift_mm };
            (from < until).then_some(bin)
        };
        let bins = setup.bins().spans().iter().filter_map(bin).collect();
        EchoShift { bins, means: Vec::new() }
    }

    /// Adds a frame.
    pub fn take(&mut self, frame: &Frame) {
        let (mut hits, mut sum) = (0.0, 0.0);
        for &Bin { code, part, shift_mm } in &self.bins {
            let count = part * f64::from(frame.histogram[code]);
            hits += count;
            sum += count * shift_mm;
        }
        if hits > 0.0 {
            self.means.push(sum / hits);
        }
    }

    /// Returns the mean over frames [mm].
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
            let Figure { value: Some(found), se: Some(se), .. } = echo.mean() else { panic!() };
            let hazard = tofsim::optics::Hazard::new(&setup.budget);
            let first = FirstPhoton::new(&setup.budget, &hazard).unwrap();
            let expected = FirstPhoton::shift_mm(first.mean_ps);
            // Hits do not lie evenly in a bin.
            assert!((found - expected).abs() < 0.1 + 4.0 * se, "{found} +-{se} for {expected}");
        }
    }
}
