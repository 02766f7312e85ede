//! `tofsim budget`: the link budget of a scenario.

use serde::Serialize;

use tofsim::error::Result;
use tofsim::firmware::vcsel_driver::PERIODS;
use tofsim::optics::{Budget, eye_safety};
use tofsim::scenario::{self, Scenario};
use tofsim::sim::setup::CYCLE;

use crate::text::table::plain;

use super::stdout::{json_line, print};

/// Print the link budget: photons and avalanches that a shot can expect, and eye safety
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// The budget, as `--json` prints it.
#[derive(Debug, Serialize)]
struct Report {
    schema: &'static str,
    scenario: String,
    distance_m: f64,
    reflectance: f64,
    time_of_flight_ps: f64,
    signal_per_shot: f64,
    noise_rate_hz: f64,
    dark_rate_hz: f64,
    pulse_energy_j: f64,
    /// Pulse energy times the firmware's laser rate.
    average_power_w: f64,
    laser_rate_hz: f64,
    /// Eq. 3.3: at the rate of the optics (Table 3.2) and its exposure.
    eye_safety_limit_w: Option<f64>,
    eye_safety_exposure_s: f64,
    /// The same at the firmware's laser rate, whose frame lasts longer.
    eye_safety_limit_at_laser_rate_w: Option<f64>,
    eye_safety_exposure_at_laser_rate_s: f64,
}

impl Report {
    fn new(name: String, scenario: &Scenario) -> Self {
        let budget = Budget::new(scenario);
        let (laser, shots) = (&scenario.laser, scenario.firmware.shots_per_frame as f64);
        let period = PERIODS[scenario.firmware.laser_freq as usize] as f64 * CYCLE.seconds();
        let exposure_s = shots / laser.repetition_rate_hz;
        let limit =
            |exposure_s| eye_safety::maximum_average_power_w(exposure_s, laser.wavelength_nm);
        Report {
            schema: "tofsim.budget/1",
            scenario: name,
            distance_m: scenario.target.distance_m,
            reflectance: scenario.target.reflectance,
            time_of_flight_ps: budget.mean_arrival.fs() as f64 / 1e3,
            signal_per_shot: budget.signal_per_shot,
            noise_rate_hz: budget.ambient_rate_hz,
            dark_rate_hz: budget.dark_rate_hz,
            pulse_energy_j: budget.pulse_energy_j,
            average_power_w: budget.pulse_energy_j / period,
            laser_rate_hz: 1.0 / period,
            eye_safety_limit_w: limit(exposure_s),
            eye_safety_exposure_s: exposure_s,
            eye_safety_limit_at_laser_rate_w: limit(shots * period),
            eye_safety_exposure_at_laser_rate_s: shots * period,
        }
    }

    fn table(&self) -> String {
        let mut table = plain();
        let mut row = |name: &str, value: String, note: String| {
            table.add_row([name.to_owned(), value, note]);
        };
        let milliwatts = |watts: Option<f64>| {
            watts.map_or("outside Table 3.1".to_owned(), |watts| format!("{:.2} mW", watts * 1e3))
        };
        let flight = format!("{:.1} ps of flight", self.time_of_flight_ps);
        row("distance", format!("{} m", self.distance_m), flight);
        row("signal", format!("{:.4}", self.signal_per_shot), "detected photons per shot".into());
        row("ambient", format!("{:.4e} /s", self.noise_rate_hz), "avalanches".into());
        row("dark", format!("{:.4e} /s", self.dark_rate_hz), "avalanches".into());
        row("pulse energy", format!("{:.1} pJ", self.pulse_energy_j * 1e12), String::new());
        let rate = format!("at {:.3} MHz", self.laser_rate_hz / 1e6);
        row("average power", milliwatts(Some(self.average_power_w)), rate);
        let exposure = |seconds: f64| format!("Class 1, {:.3} ms", seconds * 1e3);
        let note = exposure(self.eye_safety_exposure_s) + " at the optics' rate (eq. 3.3)";
        row("eye safety", milliwatts(self.eye_safety_limit_w), note);
        let note = exposure(self.eye_safety_exposure_at_laser_rate_s) + " at the firmware's rate";
        row("", milliwatts(self.eye_safety_limit_at_laser_rate_w), note);
        format!("{}\n", table.trim_fmt())
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let loaded = scenario::load(&args.scenario, &args.set)?;
    let report = Report::new(loaded.name, &loaded.scenario);
    if !args.json {
        return print(&report.table());
    }
    print(&json_line(&report)?)
}
