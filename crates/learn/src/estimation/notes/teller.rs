//! What of a scenario an estimator's model does not have, condition by condition.

use tofsim::optics::BinProbabilities;
use tofsim::scenario::wiring::Wiring;
use tofsim::scenario::{DeadTimeKind, QuenchMode};
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
/// The longest dead time for which arming is worked out [ns].
const LONGEST_DEAD_NS: f64 = 1000.0;
/// What chooses estimators.
pub const OPTION: &str = "--estimator";
/// An error that is worth a note [m].
const WORTH_M: f64 = 1e-3;

/// A distance, as a note expects it [m].
fn about(distance_m: f64) -> String {
    format!("about {distance_m:.6}")
}

/// Who says what of which scenario.
pub struct Teller<'a> {
    pub name: &'static str,
    pub setup: &'a Setup,
}

impl Teller<'_> {
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

    pub fn is_free_running(&self) -> bool {
        self.setup.scenario.firmware.mode == QuenchMode::FreeRunning
    }

    pub fn mode(&self) -> Option<Note> {
        let text = "it takes the diode to be armed at every laser edge, and the chain to be empty";
        self.is_free_running().then(|| self.note("firmware.mode", 1.0, "0", text))
    }

    /// That a shot's light is one echo of the laser's pulse.
    pub fn echo(&self) -> Option<Note> {
        let (key, value, usual) = self.setup.scenario.beside_one_echo()?;
        let text = "it takes a shot's light to be one echo of the laser's pulse, after the way along the axis";
        Some(self.note(key, value, usual, text))
    }

    pub fn jitter(&self, most_ps: f64) -> Option<Note> {
        let rms_ps = self.setup.scenario.pll.jitter_rms_ps;
        let text = "jitter blurs what pile-up has left of the pulse, and so moves it";
        let expected = format!("{most_ps} at most");
        (rms_ps > most_ps).then(|| self.note("pll.jitter_rms_ps", rms_ps, expected, text))
    }

    /// That each tap's register samples at the edge.
    pub fn metastable(&self) -> Option<Note> {
        let window_ps = self.setup.scenario.tdc.setup_window_ps;
        let text = "it takes taps to be sampled at the edge, and so bins to have sharp borders";
        (window_ps > 0.0).then(|| self.note("tdc.setup_window_ps", window_ps, "0", text))
    }

    /// That pulses are alike, or nearly.
    pub fn pulses(&self, most_ps: f64, most_energy: f64) -> Option<Note> {
        let laser = &self.setup.scenario.laser;
        let (timing_ps, energy) = (laser.timing_jitter_ps, laser.energy_jitter);
        let expected = |most: f64| format!("{most} at most");
        if timing_ps > most_ps {
            let text = "it takes the pulses of all shots to be as late";
            return Some(self.note("laser.timing_jitter_ps", timing_ps, expected(most_ps), text));
        }
        let text = "it takes the pulses of all shots to be as strong";
        let is_uneven = energy > most_energy;
        is_uneven.then(|| self.note("laser.energy_jitter", energy, expected(most_energy), text))
    }

    pub fn control(&self) -> Option<Note> {
        let changes = self.setup.scenario.control.len() as u64;
        let text = "it takes all shots of a frame to be alike";
        (changes > 0).then(|| self.note("control", changes, "no changes", text))
    }

    /// The dead times for which it is worked out how often the diode is armed.
    pub fn dead_time(&self) -> Option<Note> {
        let dead_ns = self.setup.scenario.spad.dead_time_ns;
        // A shorter pulse can pass between two edges.
        let shortest_ns = self.setup.cycle().seconds() * 1e9;
        let is_worked_out = (shortest_ns..=LONGEST_DEAD_NS).contains(&dead_ns);
        let text = "in MODE 1 it takes the diode to rest for longer than a clock period";
        let expected = format!("{shortest_ns} to {LONGEST_DEAD_NS}");
        let is_outside = self.is_free_running() && !is_worked_out;
        is_outside.then(|| self.note("spad.dead_time_ns", dead_ns, expected, text))
    }

    /// That shots are independent, or nearly.
    pub fn afterpulses(&self, most: f64) -> Option<Note> {
        let afterpulses = self.setup.scenario.spad.afterpulse_probability;
        let text =
            "it takes shots to be independent, and an afterpulse of one may be a hit of the next";
        let expected = format!("{most} at most");
        let are_many = afterpulses > most;
        are_many.then(|| self.note("spad.afterpulse_probability", afterpulses, expected, text))
    }

    /// That only light and the dark fire the SPADs on the TDC.
    pub fn neighbours(&self) -> Option<Note> {
        let spad = &self.setup.scenario.spad;
        let crosstalk = spad.crosstalk_probability;
        let text = "it takes hits to be of light and of the dark, and SPADs that are not on the TDC set off those that are";
        let are_there = crosstalk > 0.0 && Wiring::of(spad).has_unwired();
        are_there.then(|| self.note("spad.crosstalk_probability", crosstalk, "0", text))
    }

    /// That the TDC sees every avalanche of a SPAD that is armed.
    pub fn shaping(&self) -> Option<Note> {
        let (key, ns) = self.setup.scenario.spad.shaping().next()?;
        let text = "it takes the TDC to see an avalanche as long as the output of the SPAD is high";
        Some(self.note(key, ns, "0", text))
    }

    /// That the dead time is fixed.
    pub fn recharge(&self) -> Option<Note> {
        let kind = self.setup.scenario.spad.dead_time_kind;
        let text = "in MODE 1 it takes the dead time to be the same after every avalanche";
        let is_other = self.is_free_running() && kind == DeadTimeKind::Paralysable;
        is_other.then(|| self.note("spad.dead_time_kind", "paralysable", "fixed", text))
    }

    pub fn row(&self) -> Option<Note> {
        let on_tdc = u64::from(self.setup.scenario.spad.on_tdc);
        let text = "in MODE 1 it takes one diode to be on the TDC";
        (self.is_free_running() && on_tdc > 1).then(|| self.note("spad.on_tdc", on_tdc, "1", text))
    }

    /// Distance of a target whose echo arrives then [m].
    fn distance_m(&self, arrival_ps: f64) -> f64 {
        (arrival_ps - self.setup.scenario.laser.delay_ps) / ARRIVAL_PS_PER_M
    }

    /// That the light leaves with the laser edge.
    pub fn delay(&self) -> Option<Note> {
        let delay_ps = self.setup.scenario.laser.delay_ps;
        let text = "its times count from the laser edge, so that the delay is distance to it";
        (delay_ps > 0.0).then(|| self.note("laser.delay_ps", delay_ps, "0", text))
    }

    /// That the first bin comes before the pulse.
    pub fn first_bin(&self) -> Option<Note> {
        let begin_ps = self.setup.bins().spans().first()?.from.fs() as f64 * 1e-3;
        let first_ps = begin_ps + TAIL_SIGMA * self.setup.budget.pulse.sigma_ps();
        let arrival_ps = self.setup.budget.mean_arrival.fs() as f64 * 1e-3;
        let expected = format!("{:.3} at least", self.distance_m(first_ps));
        let distance_m = self.setup.scenario.target.distance_m;
        let text = "the pulse begins before the first bin, and uses up shots there";
        (arrival_ps < first_ps).then(|| self.note("target.distance_m", distance_m, expected, text))
    }

    /// That the first edge sees the echo, where that matters: in MODE 1, and with jitter.
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
                let text = "which of two jittered edges sees a hit there hangs on both";
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

    /// That the centroid's window holds the pulse.
    pub fn window(&self) -> Option<Note> {
        let half = self.setup.scenario.estimator.centroid_half_width;
        let needed =
            WINDOW_SIGMA * self.setup.budget.pulse.sigma_ps() / self.setup.scenario.tdc.bin_ps;
        let text = "its window cuts the pulse off, or begins within it";
        let expected = format!("{:.0} at least, 4 sigma of the pulse", needed.ceil());
        let is_narrow = (half as f64) < needed.floor();
        is_narrow.then(|| self.note("estimator.centroid_half_width", half, expected, text))
    }

    /// That the centroid's straight line is that of the bins: c/2 times their width, and times the begin of the
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
        let text = match scenario.laser.delay_ps > 0.0 {
            false => "what it adds is not the distance at which the first bin begins",
            true => {
                "what it adds is not the distance of the first bin's begin less the laser's delay"
            }
        };
        is_other.then(|| self.note("estimator.centroid_offset_m", offset_m, about(first_m), text))
    }

    /// That the bins are those for which the peak detection has its constants.
    pub fn thesis_bins(&self) -> Option<Note> {
        let bins = self.setup.bins();
        let text = "its constants are those of bins of 25 ps from the laser edge";
        match (bins.bin_ps(), bins.first_ps()) {
            _ if bins.are_kc705() => None,
            (bin_ps, 0.0) => Some(self.note("tdc.bin_ps", bin_ps, "25", text)),
            (_, first_ps) => Some(self.note("tdc.first_bin_ps", first_ps, "0", text)),
        }
    }

    /// That the pulse is the one to which the straight line was fitted.
    pub fn pulse(&self) -> Option<Note> {
        let laser = &self.setup.scenario.laser;
        let text = "K_d and B_d of eq. 5.2 are those of the thesis's pulse";
        if let Some(file) = &laser.pulse_file {
            return Some(self.note("laser.pulse_file", file.as_str(), "none", text));
        }
        if laser.pulse_tail_ps > OTHER_PULSE * THESIS_SIGMA_PS {
            return Some(self.note("laser.pulse_tail_ps", laser.pulse_tail_ps, "0", text));
        }
        let sigma_ps = laser.pulse_sigma_ps;
        let is_other = (sigma_ps / THESIS_SIGMA_PS - 1.0).abs() > OTHER_PULSE;
        let expected = format!("{THESIS_SIGMA_PS}");
        is_other.then(|| self.note("laser.pulse_sigma_ps", sigma_ps, expected, text))
    }

    /// That the distance is one of those to which the straight line was fitted.
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

    /// That the estimator finds the distance in the histogram that is to be expected, where that has
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
            Ok(found_m) => format!("is {:+.1} mm off", 1e3 * (found_m - truth_m)),
            Err(failure) => format!("finds {failure}"),
        };
        let text = format!("in the histogram that is to be expected here it {what}: {why}");
        Some(self.note(OPTION, self.name, "likelihood or matched, which know pile-up", &text))
    }
}
