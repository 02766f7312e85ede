//! True distances of a scene's targets.

use crate::firmware::likelihood_estimator::targets::Targets;
use crate::firmware::tof_top::FirmwareEstimator;
use crate::optics::Budget;

use super::Setup;

/// True distances, in the order in which an estimator reports targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueDepths {
    /// Distance of the target that is reported first [m].
    pub first_m: f64,
    /// Distance of the other target, if the estimator looks for it and it returns the laser's light [m].
    pub second_m: Option<f64>,
}

impl TrueDepths {
    /// Returns the order in which an estimator of `targets` reports the target and a second surface, of those distances
    /// and with the light of a budget [m].
    pub fn new(targets: Targets, target_m: f64, second_m: f64, budget: &Budget) -> Self {
        let signals = [budget.signal_per_shot + budget.retro_per_shot, budget.second_per_shot];
        let is_first = match targets {
            Targets::One => true,
            Targets::NearestFirst => target_m <= second_m,
            Targets::StrongestFirst => signals[0] >= signals[1],
        };
        let [first_m, other_m] = if is_first { [target_m, second_m] } else { [second_m, target_m] };
        match signals.map(|signal| signal > 0.0) {
            _ if !targets.has_second() => TrueDepths { first_m: target_m, second_m: None },
            [true, true] => TrueDepths { first_m, second_m: Some(other_m) },
            [false, true] => TrueDepths { first_m: second_m, second_m: None },
            [_, false] => TrueDepths { first_m: target_m, second_m: None },
        }
    }
}

impl Setup {
    /// Returns the true distances in the order in which the firmware reports targets, where a depth can be that of a
    /// target: where light and not a list or a ROM decides it, the laser's light comes back, and the histogram holds the
    /// echo. That of a pixel with a field of view of its own is the mean along its lines of sight.
    pub fn true_depths(&self) -> Option<TrueDepths> {
        if self.no_depth.is_some() {
            return None;
        }
        if self.scenario.array.is_rectangular() {
            return Some(TrueDepths { first_m: self.mean_radial_m()?, second_m: None });
        }
        Some(self.depths_reported_by(self.targets()))
    }

    /// Returns the distances of the target and a second surface in the order in which an estimator of `targets` reports
    /// them, of a pixel without a field of view of its own.
    pub fn depths_reported_by(&self, targets: Targets) -> TrueDepths {
        let target = &self.scenario.target;
        TrueDepths::new(targets, target.distance_m, target.second_distance_m, &self.budget)
    }

    /// Returns the true distance of the target that the firmware reports first [m].
    pub fn true_depth_m(&self) -> Option<f64> {
        Some(self.true_depths()?.first_m)
    }

    /// Returns the targets that the estimator in the slot looks for.
    pub fn targets(&self) -> Targets {
        let keys = &self.scenario.estimator;
        match self.params.estimator {
            FirmwareEstimator::LikelihoodEstimator => Targets::of(keys.targets, keys.order),
            _ => Targets::One,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truths(name: &str, overrides: &[&str]) -> Option<[Option<f64>; 2]> {
        let found = Setup::load(name, overrides).unwrap().true_depths()?;
        Some([Some(found.first_m), found.second_m])
    }

    #[test]
    fn depths_are_in_the_order_in_which_targets_are_reported() {
        // The net is nearer and weaker than the wall behind it.
        let two = "estimator.targets=2";
        let [net, wall] = [Some(0.35), Some(0.7)];
        assert_eq!(truths("net", &["estimator.targets=1"]), Some([wall, None]));
        assert_eq!(truths("net", &["estimator.kind=network", two]), Some([wall, None]));
        assert_eq!(truths("net", &[two]), Some([net, wall]));
        let bright = ["target.second_reflectance=0.9", "estimator.order=strongest", two];
        assert_eq!(truths("net", &bright[1..]), Some([wall, net]));
        assert_eq!(truths("net", &bright), Some([net, wall]));
    }

    #[test]
    fn a_surface_that_returns_no_light_is_no_target() {
        let set = |key: &'static str| ["estimator.targets=2", key];
        assert_eq!(truths("net", &set("target.second_share=0")), Some([Some(0.7), None]));
        assert_eq!(truths("net", &set("firmware.laser_en=false")), None);
        // The depth is that of the surface, which is not the target.
        let hidden = set("target.second_share=1");
        assert_eq!(truths("net", &hidden), None);
        let found = Setup::load("net", &hidden).unwrap().depths_reported_by(Targets::NearestFirst);
        assert_eq!(found, TrueDepths { first_m: 0.35, second_m: None });
    }
}
