//! From a scenario to a device: what elaboration, optics and stimuli come to.

mod converter;
mod detector;
mod expectations;
mod fits;
mod instrument;
mod notes;
mod recalibration;
mod stimulus;

use std::path::Path;
use std::sync::Arc;

use crate::error::{Input, Result};
use crate::files::digest::digest_of;
use crate::firmware::carry_chain::Delays;
use crate::firmware::forward2::Depth;
use crate::firmware::pll::Pll;
use crate::firmware::tof_top::{Estimator, HistogramSource, Params, Pins};
use crate::firmware::{
    centroid_estimator, frame_ctrl, histogram_builder, likelihood_estimator, tdc, vcsel_driver,
};
use crate::hierarchy;
use crate::kernel::{S, Time, U};
use crate::network::estimate::estimate;
use crate::network::{self, Network};
use crate::note::Note;
use crate::optics::dark::DarkRates;
use crate::optics::{Bins, Budget};
use crate::scenario::builtin::Source;
use crate::scenario::drift::Course;
use crate::scenario::mesh::{self, Mesh};
use crate::scenario::window::Window;
use crate::scenario::wiring::Wiring;
use crate::scenario::{self, EstimatorKind, Loaded, Scenario, dark, pulse};
use crate::sensor::light::Light;
use crate::waves::{self, WaveFormat, Waves};

use super::device::Device;
use super::disturbance::Disturbance;
use super::fast::centroid::locate;
use super::fast::likelihood;
use super::jitter::Jitter;
use super::timeline::{Timeline, pins_at_power_up};
use converter::Converter;
use detector::by_budget;
use stimulus::stimulus;

pub(super) use detector::effects;

/// Cycles of a frame beside its shots, Clear, Drain and the estimator: the hand-overs.
const HAND_OVERS: u64 = 2;
/// The same with a preloaded histogram.
const HAND_OVERS_PRELOADED: u64 = 1;

/// Shots of the waveform when nothing else is asked for.
const FIRST_SHOTS: u64 = 16;

/// 2.4 hours, well within what [`Time`] can count.
const LONGEST: Time = Time::from_ns(8 << 40);

/// A scenario, ready to run.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scenario's name.
    pub name: String,
    /// The scenario's values.
    pub scenario: Scenario,
    /// The `key=value` overrides that are in them, as given.
    pub set: Vec<String>,
    /// The link budget.
    pub budget: Budget,
    /// Avalanches in the dark.
    #[doc(hidden)]
    pub dark: DarkRates,
    /// The triangles of the target, if it is a mesh.
    #[doc(hidden)]
    pub mesh: Option<Arc<Mesh>>,
    /// What elaboration fixes in the firmware.
    #[doc(hidden)]
    pub params: Params,
    /// The delays that the TDC was calibrated by, if it has drifted since.
    calibrated: Option<Delays>,
    /// The converter as its calibration has it, if it is another.
    known_tdc: Option<tdc::Params>,
    /// What becomes of the delays in a run, if something does.
    pub(super) course: Option<Course>,
    /// What makes the chain another at each edge, if something does.
    disturbance: Option<Disturbance>,
    /// The network in the estimator.
    pub network: Network,
    /// Why no depth of a run can be that of the target, if none can.
    no_depth: Option<Note>,
    pll: Pll,
    /// What reaches the SPADs on the TDC.
    pub(super) light: Light,
    /// What reaches all that are simulated, if these are more.
    row_light: Option<Light>,
    pins: Pins,
}

impl Setup {
    /// Loads a built-in scenario by name or a file by path, with overrides such as
    /// `target.distance_m=0.3`, and makes it ready to run.
    ///
    /// # Errors
    /// When there is no such scenario, a key or value is wrong, or a file that the scenario names cannot
    /// be read or used.
    pub fn load(name: &str, overrides: &[&str]) -> Result<Self> {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        Setup::new(scenario::load(name, &overrides)?)
    }

    /// Loads the files that the scenario names and works out what it sets.
    ///
    /// # Errors
    /// When one of the files cannot be read or used, or the estimator is a network for another histogram.
    pub fn new(loaded: Loaded) -> Result<Self> {
        let setup = Setup::of_counts(loaded)?;
        match setup.params.estimator {
            Estimator::Network => setup.check_network()?,
            Estimator::Centroid => {}
            Estimator::Likelihood => {
                setup.likelihood(setup.params.frame_ctrl.shots_per_frame.into())?;
            }
        }
        Ok(setup)
    }

    /// The same for who wants histograms and not what the estimator makes of them: the network may be one for
    /// another histogram, and finds nothing then.
    ///
    /// # Errors
    /// When one of the files cannot be read or used.
    pub fn of_counts(loaded: Loaded) -> Result<Self> {
        let Loaded { name, scenario, set, files } = loaded;
        let network = network(&scenario, &files)?;
        let pll = Pll::new(&scenario.pll.params());
        let histogram = scenario.histogram();
        let converter = Converter::new(&scenario, &files, pll.cycle)?;
        let (code_source, histogram_source, light) = stimulus(&scenario, &files, &histogram)?;
        let measured = dark::load(&scenario.spad, &files)?;
        let (dark, wiring) =
            (DarkRates::new(&scenario.spad, measured.as_ref()), Wiring::of(&scenario.spad));
        let pulse = pulse::load(&scenario.laser, &files)?;
        let mesh = mesh::load(&scenario.target, &files)?;
        let budget = Budget::of_scene(&scenario, pulse, mesh.as_deref()).with_dark_rates(&dark);
        let of_row = (light.is_none() && wiring.has_unwired())
            .then(|| by_budget(&budget.of_row(&wiring, &dark), scenario.seed));
        let light = light.unwrap_or_else(|| by_budget(&budget, scenario.seed));
        let params = Params {
            histogram,
            frame_ctrl: frame_ctrl::Params {
                shots_per_frame: scenario.firmware.shots_of_a_frame() as u32,
                histogram,
                preloaded: matches!(histogram_source, HistogramSource::Preload(_)),
                drain_cycles: scenario.firmware.drain_cycles,
            },
            vcsel_driver: vcsel_driver::Params {
                periods: scenario.firmware.laser_periods.clone(),
                pulse_half_cycles: scenario.firmware.pulse_half_cycles,
            },
            tdc: converter.tdc,
            tdc_calibration: converter.tdc_calibration,
            depth_estimator: match network.fits(&histogram) {
                true => network.params(&histogram),
                false => network::blank(&histogram),
            },
            centroid_estimator: centroid(&scenario.estimator, histogram),
            likelihood_estimator: Arc::new(likelihood_estimator::params::Params::stand_in(
                histogram,
            )),
            estimator: match scenario.estimator.kind {
                EstimatorKind::Network => Estimator::Network,
                EstimatorKind::Centroid => Estimator::Centroid,
                EstimatorKind::Likelihood => Estimator::Likelihood,
            },
            code_source,
            histogram_source,
        };
        fits::check(&name, &params)?;
        let slowest = converter.course.as_ref().map_or(1.0, |course| course.slowest);
        let longest = params.tdc.delays.longest().fs() as f64 * slowest;
        fits::check_pulses(&name, &scenario, Time::from_fs(longest.ceil() as u64))?;
        if params.tdc_calibration.is_some() {
            fits::check_ring(&name, &recalibration::ring(&scenario.tdc), &params.tdc, slowest)?;
        }
        let (pins, no_depth) = (pins_at_power_up(&scenario.firmware), None);
        let mut setup = Setup {
            name,
            scenario,
            set,
            budget,
            dark,
            mesh,
            params,
            calibrated: converter.calibrated,
            known_tdc: converter.known,
            course: converter.course,
            disturbance: converter.disturbance,
            network,
            pll,
            light,
            row_light: of_row,
            pins,
            no_depth,
        };
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        // One that the estimator is not for has a stand-in, which nothing starts.
        if let Ok(own) = setup.likelihood(shots) {
            setup.params.likelihood_estimator = Arc::new(own);
        }
        Ok(Setup { no_depth: setup.why_no_depth(), ..setup })
    }

    /// Whether the network has as many inputs as the histogram has bins.
    ///
    /// # Errors
    /// When it has not.
    pub fn check_network(&self) -> Result<()> {
        let (network, bins) = (&self.network, self.params.histogram.bins);
        if network.fits(&self.params.histogram) {
            return Ok(());
        }
        let expected = format!(
            "it has {} inputs, expected {bins} as tdc.bins says: train one with those keys, or set \
             estimator.kind=centroid",
            network.fixed.bins()
        );
        let source = format!("scenario {}", self.name);
        Err(Input::new(source, expected).field("estimator.network").value(&network.name).into())
    }

    /// The clocks.
    pub fn pll(&self) -> &Pll {
        &self.pll
    }

    /// Period of `clk_sys`.
    pub fn cycle(&self) -> Time {
        self.pll.cycle
    }

    /// The device at power-up.
    pub fn device(&self) -> Device {
        let scenario = &self.scenario;
        let rms_ps = scenario.pll.jitter_rms_ps;
        let jitter = (rms_ps > 0.0).then(|| Jitter::new(rms_ps, scenario.seed));
        let calibrates = self.params.tdc_calibration.is_some();
        let front_end = detector::front_end(scenario, calibrates);
        Device::new(
            (self.pins, &self.params),
            self.pll.clone(),
            jitter,
            self.disturbance.clone(),
            self.light_of_row().clone(),
            (detector::spads(scenario, &self.dark), front_end),
            Timeline::new(scenario),
        )
    }

    /// What reaches all SPADs that are simulated.
    pub(super) fn light_of_row(&self) -> &Light {
        self.row_light.as_ref().unwrap_or(&self.light)
    }

    /// Period of the laser at power-up [cycles of clk_sys].
    pub fn laser_period(&self) -> u64 {
        self.params.vcsel_driver.period(U::new(self.scenario.firmware.laser_freq))
    }

    /// Which avalanche times give which code.
    pub fn bins(&self) -> Bins {
        Bins::of_tdc(&self.params.tdc)
    }

    /// The same as the calibration has it, for who reckons with the bins: not what they have drifted to, nor what a
    /// code density could not see.
    pub fn known_bins(&self) -> Bins {
        self.known_tdc.as_ref().map_or_else(|| self.bins(), Bins::of_tdc)
    }

    /// What makes the chain another at each edge, if something does: registers that sample at any instant of a set-up
    /// window, or delays that follow conditions.
    #[doc(hidden)]
    pub fn disturbance(&self) -> Option<&Disturbance> {
        self.disturbance.as_ref()
    }

    /// Whether the chain has drifted since its calibration.
    pub fn has_drifted(&self) -> bool {
        self.calibrated.is_some()
    }

    /// The delays that the TDC was calibrated by.
    pub fn known_delays(&self) -> &Delays {
        self.calibrated.as_ref().unwrap_or(&self.params.tdc.delays)
    }

    /// Length of an undisturbed frame with such a laser period: from the edge that begins Clear to the one
    /// that raises `algo_done` [cycles of clk_sys].
    pub fn frame_cycles(&self, laser_period: u64) -> u64 {
        let (ctrl, clear) = (&self.params.frame_ctrl, self.params.histogram.bins as u64);
        let estimator = self.params.estimator_cycles();
        if ctrl.preloaded {
            return clear + HAND_OVERS_PRELOADED + estimator;
        }
        let shots = ctrl.shots_per_frame as u64 * laser_period;
        clear + shots + ctrl.drain_cycles + HAND_OVERS + estimator
    }

    /// The depth that the estimator in the socket finds in a histogram, without its clock.
    pub fn depth(&self, histogram: &[u32]) -> Depth {
        let p = &self.params;
        match p.estimator {
            Estimator::Network => estimate(&p.depth_estimator, histogram).depth,
            Estimator::Centroid => locate(&p.centroid_estimator, histogram).depth,
            Estimator::Likelihood => likelihood::estimate(&p.likelihood_estimator, histogram).depth,
        }
    }

    /// Whether frames come in pairs, the first of each a dark one.
    pub fn has_pairs(&self) -> bool {
        self.scenario.firmware.dark_frames
    }

    /// Frames that belong together: one, or a dark and a lit one.
    pub fn frames_together(&self) -> u64 {
        if self.has_pairs() { 2 } else { 1 }
    }

    /// Shots of a run.
    pub fn shots(&self, frames: u64) -> u64 {
        let ctrl = &self.params.frame_ctrl;
        if ctrl.preloaded { 0 } else { frames.saturating_mul(ctrl.shots_per_frame as u64) }
    }

    /// When a run ends, if no control signal changes on the way: with the cycle after `frame_done`
    /// of the last frame. Jitter may move it by less than a nanosecond. Not said of runs that nobody
    /// could wait for.
    pub fn end(&self, frames: u64) -> Option<Time> {
        let firmware = &self.scenario.firmware;
        let held = firmware.rst || firmware.dsp_rst || !firmware.dsp_en;
        // A ring's edges come when they come.
        let calibrates = self.params.tdc_calibration.is_some();
        if held || calibrates || !self.scenario.control.is_empty() {
            return None;
        }
        let frame = self.frame_cycles(self.laser_period()) + 1;
        let longest = LONGEST.fs() / self.cycle().fs();
        let edge = frames.checked_mul(frame).filter(|edge| *edge < longest)? + 2;
        Some(self.pll.clk_sys.rise(edge))
    }

    /// The windows that go into the waveform: those given, or the scenario's, or a first look.
    ///
    /// # Errors
    /// When one lies past the end of the run, as far as that is known before.
    pub fn windows(&self, given: &[Window], frames: u64) -> Result<Vec<Window>> {
        let shots = self.shots(frames);
        let own = &self.scenario.report.windows;
        let (source, windows) = match (given, own.as_slice()) {
            ([], []) => {
                let first = Window::Shots { from: 0, to: shots.min(FIRST_SHOTS) };
                return Ok((shots > 0)
                    .then_some(first)
                    .into_iter()
                    .chain([Window::Estimation])
                    .collect());
            }
            ([], own) => ("report.windows", own.to_vec()),
            (given, _) => ("--window", given.to_vec()),
        };
        let end = self.end(frames).unwrap_or(Time::NEVER);
        for window in &windows {
            window
                .check(shots, end)
                .map_err(|expected| Input::new(source, expected).value(window))?;
        }
        Ok(windows)
    }

    /// Begins a waveform file of the signals that match one of `globs`, or without globs of all but the
    /// words of the RAM. It takes no part in the run before [`Run::observe`](crate::Run::observe) has it.
    ///
    /// # Errors
    /// When a glob matches no signal, or the file cannot be written.
    pub fn waves(&self, path: &Path, format: WaveFormat, globs: &[&str]) -> Result<Waves> {
        let globs: Vec<_> = globs.iter().map(|&glob| glob.to_owned()).collect();
        let entries = self.entries(&globs)?;
        let encoder = &self.params.tdc.decoder.encoder;
        Waves::create(path, format, &entries, encoder, &self.provenance())
    }

    /// The signals of a waveform that match one of `globs`, or without globs all but the words of the RAM.
    ///
    /// # Errors
    /// When a glob matches no signal.
    #[doc(hidden)]
    pub fn entries(&self, globs: &[String]) -> Result<Vec<hierarchy::Entry>> {
        let mut entries = hierarchy::entries(&self.params);
        entries.extend(hierarchy::row_entries(self.scenario.spad.row_outputs as usize));
        waves::select(entries, hierarchy::ram_entries(&self.params.histogram), globs)
    }

    /// What a file that comes of it says of where it comes from, a line each.
    pub fn provenance(&self) -> Vec<String> {
        let mut lines = vec![
            format!("tofsim {}", env!("CARGO_PKG_VERSION")),
            format!("scenario {}", self.name),
            format!("seed {}", self.scenario.seed),
        ];
        lines.extend(self.set.iter().map(|set| format!("set {set}")));
        lines.push(format!("hash {}", self.hash()));
        lines
    }

    /// A number, in hexadecimal, that changes with any key of the scenario and with what is in the files
    /// that it names.
    pub fn hash(&self) -> String {
        let (scenario, params) = (&self.scenario, &self.params);
        let given = match &self.light {
            Light::List(list) => Some(list),
            Light::Optics(_) | Light::None => None,
        };
        let pulse = &self.budget.pulse;
        let (dark, mesh) = (&self.dark, &self.mesh);
        let all = format_args!("{scenario:?} {params:?} {given:?} {pulse:?} {dark:?} {mesh:?}");
        format!("{:016x}", digest_of(all))
    }

    /// A number of cycles that no run of `frames` frames reaches unless its control signals keep
    /// it from ending: each change of theirs may begin a frame again.
    pub fn longest_run(&self, frames: u64) -> u64 {
        let changes = &self.scenario.control;
        let last_us = changes.last().map_or(0.0, |change| change.at_us);
        let block = self.params.tdc_calibration.as_ref();
        let longest_frame = self.frame_cycles(self.params.vcsel_driver.longest_period())
            + recalibration::longest(&self.scenario.tdc, block, self.cycle())
            + 16;
        let begun = frames.saturating_add(changes.len() as u64 + 1);
        let last = Time::from_ps_f64(last_us * 1e6).fs() / self.cycle().fs();
        begun.saturating_mul(longest_frame).saturating_add(last)
    }
}

fn network(scenario: &Scenario, files: &Source) -> Result<Network> {
    let folder = match files {
        Source::BuiltIn => None,
        Source::Folder(folder) => Some(folder.as_path()),
    };
    Network::find(&scenario.estimator.network, folder)
}

/// The scale's words round half away from zero.
fn centroid(
    keys: &scenario::Estimator,
    histogram: histogram_builder::Params,
) -> centroid_estimator::Params {
    let word = |value: f64, fraction: u32| (value * (1u64 << fraction) as f64).round() as i64;
    centroid_estimator::Params {
        histogram,
        half_width: keys.centroid_half_width,
        background: keys.centroid_background,
        slope: U::new(word(keys.centroid_slope_m, centroid_estimator::SLOPE_FRACTION) as u64),
        offset: S::new(word(keys.centroid_offset_m, 29)),
    }
}
