//! Acquisition of histograms, as estimators know it.

use std::f64::consts::SQRT_2;

use tofsim::error::Input;
use tofsim::kernel::Time;
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::optics::{Bins, Budget};
use tofsim::scenario::QuenchMode;
use tofsim::scenario::glass::GlassTemplate;
use tofsim::sim::setup::Setup;

/// Mean arrival of an echo for each metre of distance, 2 / c (eq. 3.23) [ps/m].
pub const ARRIVAL_PS_PER_M: f64 = 2e12 / LIGHT_M_S;

/// Most shots of a histogram: what the widest word holds [shots].
pub const MOST_SHOTS: u64 = (1 << 24) - 1;

/// Acquisition of histograms, as estimators know it.
#[derive(Clone, Copy, Debug)]
pub struct Acquisition<'a> {
    /// Avalanche times of each code, according to the calibration.
    pub bins: &'a Bins,
    /// Shots of a histogram, or of a dark and a lit one together [shots].
    pub shots: u64,
    /// The pulse as the detector times it.
    pub pulse: &'a Pulse,
    /// Standard deviation that jitter gives to a time from the laser edge to the edge that samples
    /// it, both of which are early or late by themselves [ps].
    pub jitter_ps: f64,
    /// Delay of the light after the laser edge: what an echo arrives later by than its flight takes [ps].
    pub delay_ps: f64,
    /// Recovery of the diode, if it is not armed anew for each shot (MODE 1).
    pub free_running: Option<FreeRunning>,
    /// Template of the cover window's light, whose amplitude is unknown.
    pub glass: Option<&'a GlassTemplate>,
}

/// A diode that comes back by itself, and the chain that an old pulse may still travel in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeRunning {
    /// From one laser edge to the next [ps].
    pub period_ps: f64,
    /// From an avalanche to the next possible one, and as long `tdc_stop` stays high [ps].
    pub dead_ps: f64,
    /// From one sampling edge to the next [ps].
    pub cycle_ps: f64,
    /// Age at which an edge of `tdc_stop` reaches tap 0 [ps].
    pub tap_0_ps: f64,
    /// Age at which it has left the chain [ps].
    pub chain_ps: f64,
}

impl FreeRunning {
    /// Returns the time before the laser edge by which a pulse must have ended, so that the first edge after it finds
    /// nothing of the pulse in the chain [ps].
    pub fn empty_ps(&self) -> f64 {
        (self.chain_ps - self.cycle_ps).max(self.tap_0_ps)
    }

    /// Until when codes are those of avalanches that the first edge sees: later ones may be of hits
    /// that the second edge sees with an old pulse in the chain [ps].
    pub fn first_edge_ps(&self) -> f64 {
        self.cycle_ps - self.empty_ps()
    }

    /// Of a scenario in MODE 1.
    pub fn of(setup: &Setup) -> Option<Self> {
        let firmware = &setup.scenario.firmware;
        let delays = &setup.params.tdc.delays;
        let cycles = setup.laser_period() as f64;
        (firmware.mode == QuenchMode::FreeRunning).then(|| FreeRunning {
            period_ps: cycles * ps(setup.cycle()),
            dead_ps: setup.scenario.spad.dead_time_ns * 1e3,
            cycle_ps: ps(setup.cycle()),
            tap_0_ps: ps(delays.tap_0()),
            chain_ps: ps(delays.longest()),
        })
    }
}

impl<'a> Acquisition<'a> {
    /// Of steady clocks, light that leaves with the laser edge, and a diode that is armed for each shot.
    pub fn new(bins: &'a Bins, shots: u64, pulse: &'a Pulse) -> Self {
        let (jitter_ps, delay_ps, free_running, glass) = (0.0, 0.0, None, None);
        Acquisition { bins, shots, pulse, jitter_ps, delay_ps, free_running, glass }
    }

    /// Of a scenario, with the bins of its chain.
    pub fn of(setup: &'a Setup, bins: &'a Bins, shots: u64) -> Self {
        let scenario = &setup.scenario;
        Acquisition {
            jitter_ps: SQRT_2 * scenario.pll.jitter_rms_ps,
            delay_ps: scenario.laser.delay_ps,
            free_running: FreeRunning::of(setup),
            glass: setup.glass.as_deref(),
            ..Acquisition::new(bins, shots, &setup.budget.pulse)
        }
    }

    /// Checks that a histogram has no more hits than shots. Errors name it as the one of that number in `source`.
    ///
    /// # Errors
    /// When it has more.
    pub fn check_hits(&self, source: &str, number: usize, histogram: &[u32]) -> Result<(), Input> {
        let hits: u64 = histogram.iter().map(|&count| u64::from(count)).sum();
        if hits <= self.shots {
            return Ok(());
        }
        let shots = self.shots;
        let expected =
            format!("expected {shots} hits or fewer, as many as shots (firmware.shots_per_frame)");
        Err(Input::new(source, expected).field(format!("histogram {number}")).value(hits))
    }

    /// Whether there is anything to estimate from.
    ///
    /// # Errors
    /// For no bins, no shots or more than the widest word holds, a width that is no width, or a template of other bins
    /// or in MODE 1.
    pub fn check(&self) -> Result<(), Input> {
        let fault = |field, expected| Input::new("acquisition", expected).field(field);
        if self.bins.spans().is_empty() {
            return Err(fault("bins", "expected a chain that gives a code at all"));
        }
        if !(1..=MOST_SHOTS).contains(&self.shots) {
            return Err(fault("shots", "expected 1 to 16777215").value(self.shots));
        }
        let sigma_ps = self.pulse.sigma_ps();
        if !(1.0..=1e6).contains(&sigma_ps) {
            let expected = "expected a standard deviation of 1 to 1e6 [ps]";
            return Err(fault("pulse", expected).value(sigma_ps));
        }
        let Some(glass) = self.glass else { return Ok(()) };
        if self.free_running.is_some() {
            let expected = "expected none in MODE 1 (firmware.mode): which shots find the diode armed depends on the \
                            window's light in the shots before, of which a template of hazards has nothing";
            return Err(fault("estimator.glass_file", expected));
        }
        glass.check(&self.bins.limits_ps(), self.bins.bin_ps())
    }
}

/// Parameters of a histogram: the echo of the target, and the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Echo {
    /// Mean arrival of the echo [ps].
    pub arrival_ps: f64,
    /// Detected laser photons per shot, S_p [1].
    pub signal: f64,
    /// Rate of other avalanches, N_r and dark ones [1/ps].
    pub background_per_ps: f64,
}

impl From<&Budget> for Echo {
    fn from(budget: &Budget) -> Self {
        Echo {
            arrival_ps: budget.mean_arrival.fs() as f64 * 1e-3,
            signal: budget.signal_per_shot,
            background_per_ps: budget.background_rate_hz() * 1e-12,
        }
    }
}

/// Returns the echoes of a plain scene, that of the target first and that of a second surface, at `second_m`, after it:
/// neither a patch nor the air is one [m].
pub fn echoes(budget: &Budget, second_m: f64) -> Vec<Echo> {
    let target = Echo::from(budget);
    let second = budget.second_per_shot;
    if second == 0.0 {
        return vec![target];
    }
    if budget.signal_per_shot == 0.0 {
        return vec![Echo { signal: second, ..target }];
    }
    let arrival_ps = ps(budget.delay) + second_m * ARRIVAL_PS_PER_M;
    vec![target, Echo { arrival_ps, signal: second, ..target }]
}

/// Code, begin and end of each stretch of time that has a code, in order of time [code, ps, ps].
pub fn spans_ps(bins: &Bins) -> impl Iterator<Item = (u16, f64, f64)> {
    bins.spans().iter().map(|span| (span.code, ps(span.from), ps(span.until)))
}

/// The histogram that codes of those probabilities make on average, to whole hits ([`whole_hits`]).
pub fn most_probable(probabilities: &[f64], shots: u64) -> Histogram {
    whole_hits(probabilities, shots, 0.0)
}

/// The expected histogram of so many shots to whole hits: what a bin loses by rounding the next one gets, and the
/// first one gets the part of a hit that is `owed`.
pub fn whole_hits(per_shot: &[f64], shots: u64, mut owed: f64) -> Histogram {
    let count = |&mean: &f64| {
        owed += shots as f64 * mean;
        let count = owed.round().max(0.0);
        owed -= count;
        count as u32
    };
    per_shot.iter().map(count).collect()
}

fn ps(time: Time) -> f64 {
    time.fs() as f64 * 1e-3
}
