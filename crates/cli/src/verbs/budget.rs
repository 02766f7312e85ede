//! `tofsim budget`: the link budget of a scenario.

use serde_json::json;

use tofsim::error::Result;
use tofsim::firmware::vcsel_driver::PERIODS;
use tofsim::optics::{Budget, eye_safety};
use tofsim::scenario;
use tofsim::sim::setup::CYCLE;

use crate::text::table::plain;

use super::terminal::{Talk, print_json};

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

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let loaded = scenario::load(&args.scenario, &args.set)?;
    let scenario = &loaded.scenario;
    let budget = Budget::new(scenario);
    let (laser, shots) = (&scenario.laser, scenario.firmware.shots_per_frame as f64);
    let period_s = PERIODS[scenario.firmware.laser_freq as usize] as f64 * CYCLE.seconds();
    let flight_ps = budget.mean_arrival.fs() as f64 / 1e3;
    let (energy_j, average_power_w) = (budget.pulse_energy_j, budget.pulse_energy_j / period_s);
    // Eq. 3.3 at the rate of the optics (Table 3.2) and its exposure, and at the firmware's laser rate,
    // whose frame lasts longer.
    let [exposure_s, own_exposure_s] = [shots / laser.repetition_rate_hz, shots * period_s];
    let [limit_w, own_limit_w] = [exposure_s, own_exposure_s]
        .map(|exposure_s| eye_safety::maximum_average_power_w(exposure_s, laser.wavelength_nm));
    if args.json {
        return print_json(&json!({
            "schema": "tofsim.budget/1",
            "scenario": loaded.name,
            "distance_m": scenario.target.distance_m,
            "reflectance": scenario.target.reflectance,
            "time_of_flight_ps": flight_ps,
            "signal_per_shot": budget.signal_per_shot,
            "noise_rate_hz": budget.ambient_rate_hz,
            "dark_rate_hz": budget.dark_rate_hz,
            "pulse_energy_j": energy_j,
            "average_power_w": average_power_w,
            "laser_rate_hz": 1.0 / period_s,
            "eye_safety_limit_w": limit_w,
            "eye_safety_exposure_s": exposure_s,
            "eye_safety_limit_at_laser_rate_w": own_limit_w,
            "eye_safety_exposure_at_laser_rate_s": own_exposure_s,
        }));
    }
    let milliwatts = |watts: Option<f64>| {
        watts.map_or("outside Table 3.1".to_owned(), |watts| format!("{:.2} mW", watts * 1e3))
    };
    let exposure = |seconds: f64| format!("Class 1, {:.3} ms", seconds * 1e3);
    let row = |name: &str, value: String, note: String| [name.to_owned(), value, note];
    let flight = format!("{flight_ps:.1} ps of flight");
    let rate = format!("at {:.3} MHz", 1.0 / period_s / 1e6);
    let note = exposure(exposure_s) + " at the optics' rate (eq. 3.3)";
    let own_note = exposure(own_exposure_s) + " at the firmware's rate";
    let rows = [
        row("distance", format!("{} m", scenario.target.distance_m), flight),
        row("signal", format!("{:.4}", budget.signal_per_shot), "detected photons per shot".into()),
        row("ambient", format!("{:.4e} /s", budget.ambient_rate_hz), "avalanches".into()),
        row("dark", format!("{:.4e} /s", budget.dark_rate_hz), "avalanches".into()),
        row("pulse energy", format!("{:.1} pJ", energy_j * 1e12), String::new()),
        row("average power", milliwatts(Some(average_power_w)), rate),
        row("eye safety", milliwatts(limit_w), note),
        row("", milliwatts(own_limit_w), own_note),
    ];
    talk.report(&format!("{}\n", plain(rows)))
}
