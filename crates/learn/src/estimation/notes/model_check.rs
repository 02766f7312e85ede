//! Conditions that an estimator's model asks of a scenario.

use tofsim::optics::BinProbabilities;
use tofsim::scenario::QuenchMode;
use tofsim::scenario::effects::{Effect, Method};
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode, NoteValue};

use crate::estimation::acquisition::{ARRIVAL_PS_PER_M, Acquisition, most_probable};
use crate::estimation::estimator;

/// Standard deviation of the thesis's pulse, to which K_d and B_d are fitted [ps].
const THESIS_SIGMA_PS: f64 = 137.0;
/// A pulse that is that part wider or narrower is another one [1].
const OTHER_PULSE: f64 = 0.02;
/// A straight line that is that part steeper or flatter is that of other bins [1].
const OTHER_SCALE: f64 = 0.2;
/// The distances to which they are fitted (Table 5.2) [m].
const THESIS_RANGE_M: [f64; 2] = [0.1, 0.6];
/// Part of a pulse that a centroid's window has to hold to either side [sigma].
const WINDOW_SIGMA: f64 = 4.0;
/// Part of a pulse after which the range may end [sigma].
const TAIL_SIGMA: f64 = 3.0;
/// The longest dead time for which arming is modelled [ns].
const LONGEST_DEAD_NS: f64 = 1000.0;
/// The option that chooses estimators.
pub const OPTION: &str = "--estimator";
/// An error that is worth a note [m].
const WORTH_M: f64 = 1e-3;

/// A distance, as a note expects it [m].
fn about(distance_m: f64) -> String {
    format!("about {distance_m:.6}")
}

/// Checks an estimator's model against a scenario.
pub struct ModelCheck<'a> {
    pub name: &'static str,
    pub setup: &'a Setup,
}

impl ModelCheck<'_> {
    pub fn note(
        &self,
        key: &str,
        value: impl Into<NoteValue>,
        expected: impl Into<String>,
        text: &str,
    ) -> Note {
        let text = format!("{}: {text}", self.name);
        Note::new(NoteCode::EstimatorOutsideModel, key, value, expected, text)
    }

    /// Returns a note for each effect of the scenario that the estimator's model does not have.
    pub fn effects(&self, method: Method) -> impl Iterator<Item = Note> {
        self.setup.obstacles(method).map(|found| {
            let (key, expected) = (found.key, found.expected());
            let text = format!("its model does not have this: {}", found.effect.why());
            self.note(key, found.value, expected, &text)
        })
    }

    fn is_free_running(&self) -> bool {
        self.setup.scenario.firmware.mode == QuenchMode::FreeRunning
    }

    /// Checks that the dead time is one for which the model knows how often the SPAD is armed.
    pub fn dead_time(&self) -> Option<Note> {
        let dead_ns = self.setup.scenario.spad.dead_time_ns;
        // A shorter pulse can pass between two edges.
        let shortest_ns = self.setup.cycle().seconds() * 1e9;
        let is_modelled = (shortest_ns..=LONGEST_DEAD_NS).contains(&dead_ns);
        let text = "in MODE 1 its model has dead times longer than a clock period";
        let expected = format!("{shortest_ns} to {LONGEST_DEAD_NS}");
        let is_outside = self.is_free_running() && !is_modelled;
        is_outside.then(|| self.note("spad.dead_time_ns", dead_ns, expected, text))
    }

    /// Distance of a target whose echo arrives then [m].
    fn distance_m(&self, arrival_ps: f64) -> f64 {
        (arrival_ps - self.setup.scenario.laser.delay_ps) / ARRIVAL_PS_PER_M
    }

    /// Checks that the first bin begins before the pulse.
    pub fn first_bin(&self) -> Option<Note> {
        let begin_ps = self.setup.bins().spans().first()?.from.fs() as f64 * 1e-3;
        let first_ps = begin_ps + TAIL_SIGMA * self.setup.budget.pulse.sigma_ps();
        let arrival_ps = self.setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let expected = format!("{:.3} at least", self.distance_m(first_ps));
        let distance_m = self.setup.scenario.target.distance_m;
        let text = "the pulse begins before the first bin, and uses up shots there";
        (arrival_ps < first_ps).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    /// Checks that the first edge sees the echo, where that matters: in MODE 1, and with jitter.
    pub fn first_edge(&self) -> Option<Note> {
        let scenario = &self.setup.scenario;
        let bins = self.setup.bins();
        let Acquisition { jitter_ps, free_running, .. } = Acquisition::of(self.setup, &bins, 1);
        let (edge_ps, text) = match free_running {
            Some(free) => (
                free.first_edge_ps(),
                "in MODE 1 later codes may be of hits with an old pulse in the chain",
            ),
            None if jitter_ps > 0.0 => {
                let tap_0 = self.setup.params.tdc.delays.tap_0();
                let text = "either of two jittered edges may sample a hit there";
                (self.setup.cycle().since(tap_0).fs() as f64 * 1e-3, text)
            }
            None => return None,
        };
        let last_ps = edge_ps - TAIL_SIGMA * self.setup.budget.pulse.sigma_ps().hypot(jitter_ps);
        let arrival_ps = self.setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let expected = format!("{:.3} at most", self.distance_m(last_ps));
        let distance_m = scenario.target.distance_m;
        (arrival_ps > last_ps).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    /// Checks that the centroid's window holds the pulse.
    pub fn window(&self) -> Option<Note> {
        let half = self.setup.scenario.estimator.centroid_half_width;
        let needed =
            WINDOW_SIGMA * self.setup.budget.pulse.sigma_ps() / self.setup.scenario.tdc.bin_ps;
        let text = "its window cuts the pulse off, or begins within it";
        let expected = format!("{:.0} at least, 4 sigma of the pulse", needed.ceil());
        let is_narrow = (half as f64) < needed.floor();
        is_narrow.then(|| self.note("estimator.centroid_half_width", half, expected, text))
    }

    /// Checks that the centroid's straight line is that of the bins: c/2 times their width, and times the begin of the
    /// first, less the laser's delay. What it differs by to make up for pile-up is less.
    pub fn scale(&self) -> Option<Note> {
        let scenario = &self.setup.scenario;
        let (estimator, bins) = (&scenario.estimator, self.setup.bins());
        let bin_m = bins.bin_ps() / ARRIVAL_PS_PER_M;
        let (slope_m, offset_m) = (estimator.centroid_slope_m, estimator.centroid_offset_m);
        if (slope_m / bin_m - 1.0).abs() > OTHER_SCALE {
            let text = "its distance of a bin is that of bins of another width";
            return Some(self.note("estimator.centroid_slope_m", slope_m, about(bin_m), text));
        }
        let first_m = self.distance_m(bins.first_ps());
        let is_other = first_m != 0.0 && (offset_m - first_m).abs() > OTHER_SCALE * first_m.abs();
        let text = if scenario.laser.delay_ps > 0.0 {
            "its offset is not the distance of the start of the first bin minus that of the laser's delay"
        } else {
            "its offset is not the distance at which the first bin starts"
        };
        is_other.then(|| self.note("estimator.centroid_offset_m", offset_m, about(first_m), text))
    }

    /// Checks that the bins are those for which the peak detection has its constants.
    pub fn thesis_bins(&self) -> Option<Note> {
        let bins = self.setup.bins();
        let text = "its constants are those of bins of 25 ps from the laser edge";
        match (bins.bin_ps(), bins.first_ps()) {
            _ if bins.are_kc705() => None,
            (bin_ps, 0.0) => Some(self.note("tdc.bin_ps", bin_ps, "25", text)),
            (_, first_ps) => Some(self.note("tdc.first_bin_ps", first_ps, "0", text)),
        }
    }

    /// Checks that the pulse is as wide as the one to which the straight line was fitted.
    pub fn pulse_width(&self) -> Option<Note> {
        let sigma_ps = self.setup.scenario.laser.pulse_sigma_ps;
        let is_measured = Effect::MeasuredPulse.occurrence(&self.setup.scenario).is_some();
        let is_other = (sigma_ps / THESIS_SIGMA_PS - 1.0).abs() > OTHER_PULSE;
        let text = Effect::MeasuredPulse.why();
        let expected = format!("{THESIS_SIGMA_PS}");
        (is_other && !is_measured)
            .then(|| self.note("laser.pulse_sigma_ps", sigma_ps, expected, text))
    }

    /// Checks that the distance is one of those to which the straight line was fitted.
    pub fn range(&self) -> Option<Note> {
        let distance_m = self.setup.scenario.target.distance_m;
        let [first, last] = THESIS_RANGE_M;
        let text = "K_d and B_d of eq. 5.2 are those of the thesis's distances";
        let is_within = (first..=last).contains(&distance_m);
        let expected = format!("{first} to {last}");
        (!is_within).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    pub fn shots(&self) -> u64 {
        self.setup.params.frame_ctrl.shots_per_frame.into()
    }

    /// Checks that the estimator finds the distance in the histogram that is to be expected, where that has
    /// a closed form.
    pub fn expected(&self, estimator: &dyn estimator::Estimator, why: &str) -> Option<Note> {
        let setup = self.setup;
        let (optics, _) = independent_shots(setup, self.name).ok()?;
        let is_lit = setup.scenario.firmware.laser_en && setup.budget.laser_per_shot() > 0.0;
        let truth_m = setup.true_depth_m().filter(|_| is_lit)?;
        let codes = BinProbabilities::new(optics.hazard(true), &self.setup.bins());
        let histogram = most_probable(codes.of_code(), self.shots());
        let what = match estimator.estimate(&histogram) {
            Ok(found_m) if (found_m - truth_m).abs() <= WORTH_M => return None,
            Ok(found_m) => format!("is off by {:+.1} mm", 1e3 * (found_m - truth_m)),
            Err(failure) => format!("finds {failure}"),
        };
        let text = format!("in the expected histogram of this scene it {what}: {why}");
        Some(self.note(OPTION, self.name, "likelihood or matched, which know pile-up", &text))
    }
}
