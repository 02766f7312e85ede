//! Pairs of a dark and a lit frame, as they come, and what JSON tells of them.

use serde::Serialize;

use tofsim::network::Histogram;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::subtraction::NAME;
use tofsim_learn::estimation::{Estimate, HistogramPair, Panel};

use super::statistics::Moments;

/// End of the echo behind its mean [sigma].
const REACH: f64 = 4.0;

/// A frame's place in a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceInPair {
    /// The pair, from 0.
    pub pair: u64,
    /// Whether the laser was on.
    pub laser_en: bool,
    /// Difference of the pair, in frames with the laser on.
    #[serde(flatten)]
    pub difference: Option<Difference>,
}

/// A lit histogram less a dark one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Counts, which may be negative [hits].
    pub difference: Vec<i32>,
    /// Their mean over the bins right of the echo; none where no light was simulated, or no bin is
    /// left [hits].
    pub right_of_echo: Option<f64>,
}

/// Statistics of the pairs under subtraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PairStatistics {
    /// Number of pairs.
    pub count: u64,
    /// Pairs without a distance; none if subtraction is not among the estimators.
    pub failures: Option<u64>,
    /// Mean of the distances that it found [m].
    pub mean_m: Option<f64>,
    /// Two standard deviations of them, with n - 1 [m].
    pub two_sd_m: Option<f64>,
    /// Mean of `right_of_echo` over the pairs [hits].
    pub right_of_echo: Option<f64>,
}

/// Makes pairs of frames as they come.
#[derive(Debug, Default)]
pub struct PairLog {
    /// First bin that lies right of the echo.
    right: Option<usize>,
    dark: Option<Histogram>,
    count: u64,
    readings: u64,
    depths: Moments,
    rights: Moments,
}

impl PairLog {
    /// No pair of `setup` yet.
    pub fn new(setup: &Setup) -> Self {
        PairLog { right: right_of_echo(setup), ..PairLog::default() }
    }

    /// Takes the next frame; returns its place and, if it ends a pair, what the estimators say of
    /// that.
    pub fn take(&mut self, frame: &Frame, panel: &Panel) -> (Option<PlaceInPair>, Vec<Estimate>) {
        let mut paired =
            PlaceInPair { pair: self.count, laser_en: frame.laser_en, difference: None };
        if !frame.laser_en {
            self.dark = Some(frame.histogram.clone());
            return (Some(paired), Vec::new());
        }
        let Some(dark) = self.dark.take() else { return (Some(paired), Vec::new()) };
        let pair = HistogramPair { dark, lit: frame.histogram.clone() };
        let difference = pair.difference();
        let right_of_echo = self.right.map(|bin| mean(&difference[bin..]));
        paired.difference = Some(Difference { difference, right_of_echo });
        let readings = panel.read_pair(&pair);
        self.count += 1;
        right_of_echo.into_iter().for_each(|hits| self.rights.add(hits));
        if let Some(reading) = readings.iter().find(|reading| reading.estimator == NAME) {
            self.readings += 1;
            reading.depth_m.into_iter().for_each(|depth_m| self.depths.add(depth_m));
        }
        (Some(paired), readings)
    }

    /// Returns the statistics of the pairs so far.
    pub fn statistics(&self) -> PairStatistics {
        PairStatistics {
            count: self.count,
            failures: (self.readings > 0).then(|| self.readings - self.depths.count),
            mean_m: self.depths.mean(),
            two_sd_m: self.depths.two_sd(),
            right_of_echo: self.rights.mean(),
        }
    }
}

/// Returns the first bin after the echo, if there is one; none if air, a second surface or a cover window sends light
/// back too.
pub fn right_of_echo(setup: &Setup) -> Option<usize> {
    setup.true_depth_m()?;
    let budget = &setup.budget;
    let others = [budget.backscatter_per_shot, budget.second_per_shot, budget.cover_per_shot];
    if others.iter().any(|photons| *photons > 0.0) {
        return None;
    }
    let [_, last] = budget.target_ends();
    let echo_ps = last.fs() as f64 * 1e-3 + REACH * budget.pulse.sigma_ps();
    let tdc = &setup.scenario.tdc;
    let bin = ((echo_ps - tdc.first_bin_ps) / tdc.bin_ps).ceil().max(0.0) as usize;
    (bin < setup.params.histogram.bins).then_some(bin)
}

/// Mean of counts, signed [hits].
pub(super) fn mean(counts: &[i32]) -> f64 {
    counts.iter().map(|&count| i64::from(count)).sum::<i64>() as f64 / counts.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;
    use tofsim::sim::fast::histogram::Histograms;
    use tofsim_learn::estimation::EstimatorKind;

    fn setup(keys: &[&str]) -> Setup {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap()
    }

    #[test]
    fn a_lit_frame_goes_with_the_dark_one_before_it() {
        let setup = setup(&["firmware.dark_frames=true", "firmware.shots_per_frame=2000"]);
        let panel = Panel::new(&[EstimatorKind::Subtraction, EstimatorKind::Peak], &setup).unwrap();
        let histograms = Histograms::new(&setup).unwrap();
        let mut pairs = PairLog::new(&setup);
        for index in 0..6 {
            let frame = histograms.frame(index);
            let (paired, readings) = pairs.take(&frame, &panel);
            let paired = paired.unwrap();
            let lit = index % 2 == 1;
            assert_eq!((paired.pair, paired.laser_en), (index / 2, lit));
            assert_eq!((paired.difference.is_some(), readings.len()), (lit, 2 * lit as usize));
            if let Some(Difference { difference, .. }) = paired.difference {
                let dark = histograms.frame(index - 1).histogram;
                let summed = difference.iter().zip(&dark).map(|(&more, &dark)| more + dark as i32);
                assert!(summed.eq(frame.histogram.iter().map(|&count| count as i32)));
            }
        }
        assert_eq!(pairs.statistics().count, 3);
    }

    #[test]
    fn the_bins_right_of_the_echo_begin_four_sigma_behind_it() {
        // 2 d / c is 3335.64 ps, 4 sigma are 548 ps, and 3883.64 / 25 is 155.3.
        assert_eq!(right_of_echo(&setup(&[])), Some(156));
        assert_eq!(right_of_echo(&setup(&["target.distance_m=0.9"])), None);
        assert_eq!(right_of_echo(&setup(&["atmosphere.visibility_m=50"])), None);
        // The half of a step that stands at 0.7 m, and up to 1 / cos 10.5 deg as far.
        let step = right_of_echo(&setup(&["target.shape=step"])).unwrap();
        assert!((208..=213).contains(&step), "{step}");
    }
}
