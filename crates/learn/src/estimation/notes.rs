//! What the estimators take for granted, and what of it a scenario does not have.
//!
//! The network's own limits are those of its training; they are not told here.

use tofsim::firmware::tof_top::Estimator;
use tofsim::optics::BinProbabilities;
use tofsim::scenario::QuenchMode;
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode, NoteValue};

use super::acquisition::{ARRIVAL_PS_PER_M, Acquisition, most_probable};
use super::by_name::EstimatorKind;
use super::centroid::Centroid;
use super::estimator;
use super::peak_detection::PeakDetection;

/// Jitter of an edge that moves centroid and peak by a tenth of a millimetre [ps].
const JITTER_PS: f64 = 20.0;
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
/// The longest dead time for which arming is worked out [ns].
const LONGEST_DEAD_NS: f64 = 1000.0;
/// What chooses estimators.
const OPTION: &str = "--estimator";
/// An error that is worth a note [m].
const WORTH_M: f64 = 1e-3;

impl EstimatorKind {
    /// What this estimator takes for granted and the scenario does not have, whatever the scene.
    pub fn notes(self, setup: &Setup) -> Vec<Note> {
        let teller = Teller { name: self.name(), setup };
        let found = match self {
            EstimatorKind::Network | EstimatorKind::NetworkFloat => [None, None, None, None],
            EstimatorKind::Likelihood => [teller.dead_time(), teller.row(), teller.control(), None],
            EstimatorKind::LikelihoodEstimator => {
                [teller.jitter(0.0), teller.control(), None, None]
            }
            EstimatorKind::Matched => [teller.mode(), teller.jitter(0.0), teller.control(), None],
            EstimatorKind::Centroid => {
                [teller.mode(), teller.jitter(JITTER_PS), teller.window(), teller.scale()]
            }
            EstimatorKind::Peak | EstimatorKind::Subtraction => {
                [teller.mode(), teller.jitter(JITTER_PS), teller.pulse(), teller.thesis_bins()]
            }
        };
        found.into_iter().flatten().collect()
    }

    /// The same for the scene of the scenario, too: what the estimator makes of the histogram that
    /// is to be expected.
    pub fn notes_of_scene(self, setup: &Setup) -> Vec<Note> {
        let teller = Teller { name: self.name(), setup };
        let of_scene = match self {
            EstimatorKind::Likelihood => teller.first_bin().or_else(|| teller.first_edge()),
            EstimatorKind::Matched => teller.first_bin(),
            EstimatorKind::Centroid => teller
                .expected(&Centroid(setup.params.centroid_estimator), "pile-up makes it early"),
            EstimatorKind::Peak => teller.range().or_else(|| {
                let detection = PeakDetection::of_bins(teller.shots(), &teller.setup.bins());
                teller.expected(&detection, "its straight line knows neither signal nor background")
            }),
            EstimatorKind::Subtraction => teller.range(),
            _ => None,
        };
        self.notes(setup).into_iter().chain(of_scene).collect()
    }
}

/// What the estimator in the firmware's socket takes for granted of the scenario and its scene; the
/// network's limits are those of its training.
pub fn notes_of_firmware(setup: &Setup) -> Vec<Note> {
    let Estimator::Centroid = setup.params.estimator else { return Vec::new() };
    let mut notes = EstimatorKind::Centroid.notes_of_scene(setup);
    for note in notes.iter_mut().filter(|note| note.key == OPTION) {
        "estimator.kind".clone_into(&mut note.key);
        "network".clone_into(&mut note.expected);
    }
    notes
}

/// A distance, as a note expects it [m].
fn about(distance_m: f64) -> String {
    format!("about {distance_m:.6}")
}

/// Who says what of which scenario.
struct Teller<'a> {
    name: &'static str,
    setup: &'a Setup,
}

impl Teller<'_> {
    fn note(
        &self,
        key: &str,
        value: impl Into<NoteValue>,
        expected: impl Into<String>,
        text: &str,
    ) -> Note {
        let text = format!("{}: {text}", self.name);
        Note::new(NoteCode::EstimatorOutsideModel, key, value, expected, text)
    }

    fn is_free_running(&self) -> bool {
        self.setup.scenario.firmware.mode == QuenchMode::FreeRunning
    }

    fn mode(&self) -> Option<Note> {
        let text = "it takes the diode to be armed at every laser edge, and the chain to be empty";
        self.is_free_running().then(|| self.note("firmware.mode", 1.0, "0", text))
    }

    fn jitter(&self, most_ps: f64) -> Option<Note> {
        let rms_ps = self.setup.scenario.pll.jitter_rms_ps;
        let text = "jitter blurs what pile-up has left of the pulse, and so moves it";
        let expected = format!("{most_ps} at most");
        (rms_ps > most_ps).then(|| self.note("pll.jitter_rms_ps", rms_ps, expected, text))
    }

    fn control(&self) -> Option<Note> {
        let changes = self.setup.scenario.control.len() as u64;
        let text = "it takes all shots of a frame to be alike";
        (changes > 0).then(|| self.note("control", changes, "no changes", text))
    }

    /// The dead times for which it is worked out how often the diode is armed.
    fn dead_time(&self) -> Option<Note> {
        let dead_ns = self.setup.scenario.spad.dead_time_ns;
        // A shorter pulse can pass between two edges.
        let shortest_ns = self.setup.cycle().seconds() * 1e9;
        let is_worked_out = (shortest_ns..=LONGEST_DEAD_NS).contains(&dead_ns);
        let text = "in MODE 1 it takes the diode to rest for longer than a clock period";
        let expected = format!("{shortest_ns} to {LONGEST_DEAD_NS}");
        let is_outside = self.is_free_running() && !is_worked_out;
        is_outside.then(|| self.note("spad.dead_time_ns", dead_ns, expected, text))
    }

    fn row(&self) -> Option<Note> {
        let on_tdc = u64::from(self.setup.scenario.spad.on_tdc);
        let text = "in MODE 1 it takes one diode to be on the TDC";
        (self.is_free_running() && on_tdc > 1).then(|| self.note("spad.on_tdc", on_tdc, "1", text))
    }

    /// That the first bin comes before the pulse.
    fn first_bin(&self) -> Option<Note> {
        let begin_ps = self.setup.bins().spans().first()?.from.fs() as f64 * 1e-3;
        let first_ps = begin_ps + TAIL_SIGMA * self.setup.scenario.laser.pulse_sigma_ps;
        let arrival_ps = self.setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let expected = format!("{:.3} at least", first_ps / ARRIVAL_PS_PER_M);
        let distance_m = self.setup.scenario.target.distance_m;
        let text = "the pulse begins before the first bin, and uses up shots there";
        (arrival_ps < first_ps).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    /// That the first edge sees the echo, where that matters: in MODE 1, and with jitter.
    fn first_edge(&self) -> Option<Note> {
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
                let text = "which of two jittered edges sees a hit there hangs on both";
                (self.setup.cycle().since(tap_0).fs() as f64 * 1e-3, text)
            }
            None => return None,
        };
        let last_ps = edge_ps - TAIL_SIGMA * scenario.laser.pulse_sigma_ps.hypot(jitter_ps);
        let arrival_ps = self.setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let expected = format!("{:.3} at most", last_ps / ARRIVAL_PS_PER_M);
        let distance_m = scenario.target.distance_m;
        (arrival_ps > last_ps).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    /// That the centroid's window holds the pulse.
    fn window(&self) -> Option<Note> {
        let half = self.setup.scenario.estimator.centroid_half_width;
        let needed = WINDOW_SIGMA * self.setup.scenario.laser.pulse_sigma_ps
            / self.setup.scenario.tdc.bin_ps;
        let text = "its window cuts the pulse off, or begins within it";
        let expected = format!("{:.0} at least, 4 sigma of the pulse", needed.ceil());
        let is_narrow = (half as f64) < needed.floor();
        is_narrow.then(|| self.note("estimator.centroid_half_width", half, expected, text))
    }

    /// That the centroid's straight line is that of the bins: c/2 times their width, and times the begin of the
    /// first. What it differs by to make up for pile-up is less.
    fn scale(&self) -> Option<Note> {
        let scenario = &self.setup.scenario;
        let (estimator, bins) = (&scenario.estimator, self.setup.bins());
        let bin_m = bins.bin_ps() / ARRIVAL_PS_PER_M;
        let (slope_m, offset_m) = (estimator.centroid_slope_m, estimator.centroid_offset_m);
        if (slope_m / bin_m - 1.0).abs() > OTHER_SCALE {
            let text = "its distance of a bin is that of bins of another width";
            return Some(self.note("estimator.centroid_slope_m", slope_m, about(bin_m), text));
        }
        let first_m = bins.first_ps() / ARRIVAL_PS_PER_M;
        let is_other = first_m > 0.0 && (offset_m - first_m).abs() > OTHER_SCALE * first_m;
        let text = "what it adds is not the distance at which the first bin begins";
        is_other.then(|| self.note("estimator.centroid_offset_m", offset_m, about(first_m), text))
    }

    /// That the bins are those for which the peak detection has its constants.
    fn thesis_bins(&self) -> Option<Note> {
        let bins = self.setup.bins();
        let text = "its constants are those of bins of 25 ps from the laser edge";
        match (bins.bin_ps(), bins.first_ps()) {
            _ if bins.are_kc705() => None,
            (bin_ps, 0.0) => Some(self.note("tdc.bin_ps", bin_ps, "25", text)),
            (_, first_ps) => Some(self.note("tdc.first_bin_ps", first_ps, "0", text)),
        }
    }

    /// That the pulse is the one to which the straight line was fitted.
    fn pulse(&self) -> Option<Note> {
        let sigma_ps = self.setup.scenario.laser.pulse_sigma_ps;
        let is_other = (sigma_ps / THESIS_SIGMA_PS - 1.0).abs() > OTHER_PULSE;
        let text = "K_d and B_d of eq. 5.2 are those of the thesis's pulse";
        let expected = format!("{THESIS_SIGMA_PS}");
        is_other.then(|| self.note("laser.pulse_sigma_ps", sigma_ps, expected, text))
    }

    /// That the distance is one of those to which the straight line was fitted.
    fn range(&self) -> Option<Note> {
        let distance_m = self.setup.scenario.target.distance_m;
        let [first, last] = THESIS_RANGE_M;
        let text = "K_d and B_d of eq. 5.2 are those of the thesis's distances";
        let is_within = (first..=last).contains(&distance_m);
        let expected = format!("{first} to {last}");
        (!is_within).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    fn shots(&self) -> u64 {
        self.setup.params.frame_ctrl.shots_per_frame.into()
    }

    /// That the estimator finds the distance in the histogram that is to be expected, where that has
    /// a closed form.
    fn expected(&self, estimator: &dyn estimator::Estimator, why: &str) -> Option<Note> {
        let setup = self.setup;
        let (optics, _) = independent_shots(setup, self.name).ok()?;
        let is_lit = setup.scenario.firmware.laser_en && setup.budget.signal_per_shot > 0.0;
        let truth_m = setup.true_depth_m().filter(|_| is_lit)?;
        let codes = BinProbabilities::new(optics.hazard(true), &self.setup.bins());
        let histogram = most_probable(codes.of_code(), self.shots());
        let what = match estimator.estimate(&histogram) {
            Ok(found_m) if (found_m - truth_m).abs() <= WORTH_M => return None,
            Ok(found_m) => format!("is {:+.1} mm off", 1e3 * (found_m - truth_m)),
            Err(failure) => format!("finds {failure}"),
        };
        let text = format!("in the histogram that is to be expected here it {what}: {why}");
        Some(self.note(OPTION, self.name, "likelihood or matched, which know pile-up", &text))
    }
}

#[cfg(test)]
mod tests;
