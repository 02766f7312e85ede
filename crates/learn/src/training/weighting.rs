//! Weight of an error at a distance: relative to the limit that the network is to stay below.

use serde::{Deserialize, Serialize};

use tofsim::error::{Input, Result};

use crate::dataset::axis::thinned;
use crate::dataset::grid::DISTANCE;
use crate::dataset::{Grid, HistogramSource};
use crate::evaluation::{bound, thesis};

/// The line, and more weight at both ends of the range, where there are no neighbours to learn from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Weighting {
    /// Distances of the line's corners, ascending [m].
    pub distances_m: Vec<f64>,
    /// Twice the standard deviation of the depth to stay below at each [mm].
    pub two_sd_mm: Vec<f64>,
    /// Mean error to stay below at any distance; decides between the blocks of the end [mm].
    pub mean_mm: f64,
    /// Extra weight at the nearest distance [1].
    pub near: f64,
    /// Extra weight at the farthest distance [1].
    pub far: f64,
    /// Length over which the extra weight falls by e [m].
    pub reach_m: f64,
}

impl Default for Weighting {
    /// Table 5.5 of the thesis is the line.
    fn default() -> Self {
        Weighting {
            distances_m: thesis::DISTANCES_M.to_vec(),
            two_sd_mm: thesis::FLOAT.two_sd_mm.to_vec(),
            mean_mm: 1.0,
            near: 0.5,
            far: 2.5,
            reach_m: 0.006,
        }
    }
}

/// The line over the Cramer-Rao bound, where the line is not the thesis's: its own is 2.9 to 7.3 times
/// the bound at its distances, 5.0 in the geometric mean [1].
const LINE_OVER_BOUND: f64 = 5.0;
/// A bound that tells nothing: about what the histogram reaches over [mm].
const NOTHING_MM: f64 = 1000.0;
/// The limit of the mean error over the line's mean; the thesis's line has 1 mm over 3.17 mm [1].
const MEAN_OVER_LINE: f64 = 1.0 / 3.17;
/// Length of the extra weight at the ends, in distances of the training grid; 6 mm over 2.5 mm [1].
const REACH: f64 = 2.4;

/// The line where there is no bound [mm].
const FLAT_MM: f64 = 5.0;

/// Length of the extra weight at the ends of distances that rise [m].
fn reach_m(distances_m: &[f64]) -> f64 {
    match distances_m {
        [first, .., last] => REACH * (last - first) / (distances_m.len() - 1) as f64,
        _ => Weighting::default().reach_m,
    }
}

impl Weighting {
    /// For scenes of one's own: the line is in proportion to the bound at each distance of the tests, the
    /// rest is to the line and to the training's distances as the thesis's is. Where light is not one echo, which has no
    /// bound, the line is flat.
    ///
    /// # Errors
    /// When a scene tells nothing of its distance, as without signal.
    pub fn of_scenes(source: &HistogramSource, training: &Grid, test: &Grid) -> Result<Self> {
        let distances_m = test.distances_m.values.clone();
        if source.scenarios().any(|scenario| scenario.complex_scene().is_some()) {
            // There is no bound to go by.
            let flat = Weighting::flat(&distances_m);
            return Ok(Weighting { reach_m: reach_m(&training.distances_m.values), ..flat });
        }
        let bound = bound::two_sd_mm(source, test, &distances_m)?;
        let mut two_sd_mm = Vec::with_capacity(bound.len());
        for (distance_m, bound_mm) in distances_m.iter().zip(bound) {
            let Some(bound_mm) = bound_mm.filter(|mm| *mm > 0.0 && *mm < NOTHING_MM) else {
                let expected = "a scene there tells nothing of its distance, as without signal or with \
                    an echo past the last bin";
                return Err(Input::new("--grid", expected)
                    .field(DISTANCE)
                    .value(distance_m)
                    .into());
            };
            two_sd_mm.push(LINE_OVER_BOUND * bound_mm);
        }
        let mean_mm = MEAN_OVER_LINE * two_sd_mm.iter().sum::<f64>() / two_sd_mm.len() as f64;
        let reach_m = reach_m(&training.distances_m.values);
        Ok(Weighting { distances_m, two_sd_mm, mean_mm, reach_m, ..Weighting::default() })
    }

    /// For histograms whose light is not known: the same line at all distances, which rise.
    pub fn flat(distances_m: &[f64]) -> Self {
        let corners = thinned(distances_m, 51);
        let (two_sd_mm, mean_mm) = (vec![FLAT_MM; corners.len()], MEAN_OVER_LINE * FLAT_MM);
        let weighting =
            Weighting { distances_m: corners, two_sd_mm, mean_mm, ..Weighting::default() };
        Weighting { reach_m: reach_m(distances_m), ..weighting }
    }

    /// Checks that there is a limit, and that it is positive.
    pub(super) fn check(&self) -> Result<()> {
        let (distances_m, two_sd_mm) = (&self.distances_m, &self.two_sd_mm);
        let rises = !distances_m.is_empty() && distances_m.is_sorted_by(|a, b| a < b);
        let above_0 = |values: &[f64]| values.iter().all(|x| *x > 0.0 && x.is_finite());
        let are_above_0 = above_0(two_sd_mm) && above_0(&[self.reach_m, self.mean_mm]);
        let is_extra = |extra: f64| extra >= 0.0 && extra.is_finite();
        let checks = [
            ("distances_m", rises, "expected ascending distances, one at least"),
            ("two_sd_mm", two_sd_mm.len() == distances_m.len(), "expected one a distance"),
            ("two_sd_mm", are_above_0, "expected numbers above 0, and so for reach_m and mean_mm"),
            (
                "near",
                is_extra(self.near) && is_extra(self.far),
                "expected 0 or more, and so for far",
            ),
        ];
        match checks.into_iter().find(|(_, holds, _)| !holds) {
            None => Ok(()),
            Some((field, _, expected)) => {
                Err(Input::new("recipe", expected).field(format!("weighting.{field}")).into())
            }
        }
    }

    /// The line at a distance, straight between corners [mm].
    pub fn line_mm(&self, distance_m: f64) -> f64 {
        let (distances, line) = (&self.distances_m, &self.two_sd_mm);
        let next = distances.partition_point(|&corner| corner < distance_m);
        if next == 0 {
            return line[0];
        }
        if next == distances.len() {
            return line[next - 1];
        }
        let share = (distance_m - distances[next - 1]) / (distances[next] - distances[next - 1]);
        line[next - 1] + share * (line[next] - line[next - 1])
    }

    /// Weight u of an error at a distance [1/m].
    pub fn weight(&self, distance_m: f64) -> f64 {
        let (first, last) = (self.distances_m[0], self.distances_m[self.distances_m.len() - 1]);
        let near = self.near * libm::exp(-(distance_m - first).abs() / self.reach_m);
        let far = self.far * libm::exp(-(last - distance_m).abs() / self.reach_m);
        2000.0 / self.line_mm(distance_m) * (1.0 + near + far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    #[test]
    fn the_weight_is_one_over_the_line_s_standard_deviation_and_more_at_the_ends() {
        let weighting = Weighting::default();
        assert!((weighting.line_mm(0.35) - 3.1).abs() < 1e-12);
        assert!((weighting.weight(0.35) - 1.0 / 1.55e-3).abs() < 1e-9);
        assert!((weighting.weight(0.1) - 1.5 / 0.8e-3).abs() < 1e-9);
        assert!((weighting.weight(0.6) - 3.5 / 2.45e-3).abs() < 1e-9);
        assert_eq!((weighting.line_mm(0.0), weighting.line_mm(1.0)), (1.6, 4.9));
    }

    #[test]
    fn the_line_for_other_scenes_is_in_proportion_to_the_bound() {
        let source = |keys: &[&str]| {
            let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
            let setup = Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap();
            HistogramSource::new(&setup).unwrap()
        };
        let (own, thesis) = (Grid::test(), Weighting::default());
        let line = Weighting::of_scenes(&source(&[]), &Grid::training(), &own).unwrap();
        assert_eq!(line.distances_m.len(), 51);
        // Near the thesis's own line, over the thesis's own scenes.
        let ratio = |d: &f64| line.line_mm(*d) / thesis.line_mm(*d);
        assert!(thesis.distances_m.iter().all(|d| (0.6..1.8).contains(&ratio(d))));
        assert!((line.reach_m - 0.006).abs() < 1e-12 && (0.5..1.5).contains(&line.mean_mm));
        // Half the shots: the bound is larger by the root of 2.
        let fewer = source(&["firmware.shots_per_frame=15000"]);
        let wider = Weighting::of_scenes(&fewer, &Grid::training(), &own).unwrap();
        assert!((wider.line_mm(0.3) / line.line_mm(0.3) - 2f64.sqrt()).abs() < 0.01);
        let dark = source(&["laser.average_power_w=0"]);
        let error = Weighting::of_scenes(&dark, &Grid::training(), &own).unwrap_err().to_string();
        assert!(error.contains("target.distance_m = 0.1: a scene there tells nothing"), "{error}");
    }

    #[test]
    fn a_line_without_sense_is_refused() {
        let fault = |change: fn(&mut Weighting)| {
            let mut weighting = Weighting::default();
            change(&mut weighting);
            weighting.check().unwrap_err().to_string()
        };
        assert!(fault(|w| w.distances_m.swap(0, 1)).contains("weighting.distances_m"));
        assert!(fault(|w| w.two_sd_mm.truncate(2)).contains("one a distance"));
        assert!(fault(|w| w.two_sd_mm[3] = 0.0).contains("above 0"));
        assert!(fault(|w| w.far = f64::NAN).contains("0 or more"));
    }
}
