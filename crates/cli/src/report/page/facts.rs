//! What the instrument is, in numbers with units.

use serde_json::Value;

use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::scenario::show::schema;
use tofsim::scenario::{Part, Scenario};
use tofsim::sim::setup::Setup;

use crate::page::html::table;

/// Distances that the bins hold.
pub fn range_m(setup: &Setup) -> String {
    let (tdc, laser) = (&setup.scenario.tdc, &setup.scenario.laser);
    let metres = |ps: f64| (ps - laser.delay_ps).max(0.0) * 1e-12 * LIGHT_M_S / 2.0;
    let first = metres(tdc.first_bin_ps);
    let window_ps = setup.cycle().fs() as f64 / 1e3 * f64::from(1 << tdc.coarse_bits);
    let end = metres((tdc.first_bin_ps + tdc.bins as f64 * tdc.bin_ps).min(window_ps));
    format!("{} to {} m", short(first), short((end * 1e3).round() / 1e3))
}

/// Depths in a second.
pub fn frame_rate(setup: &Setup) -> String {
    let cycles = setup.frame_cycles(setup.laser_period()) + 1;
    format!("{} per s", short(1.0 / (cycles as f64 * setup.cycle().seconds())))
}

/// A number with four digits that say something.
fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let digits = (3 - number.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{number:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// What it is.
pub fn section(setup: &Setup, network: &Value) -> String {
    let scenario = &setup.scenario;
    let mut facts = facts(setup);
    match (network["from"].as_str(), network["because"].as_str()) {
        (Some(from), _) => facts.push(("network", format!("{from}, as the file says"))),
        (_, Some(because)) => facts.push(("network", format!("trained in this build: {because}"))),
        _ => {}
    }
    let rows = facts.into_iter().map(|(what, value)| [what.to_owned(), value]);
    let others: Vec<_> = others(scenario);
    let keys = match others.is_empty() {
        true => "<p>Every key is the KC705's.</p>\n".to_owned(),
        false => table(&["key", "value", "unit", "KC705"], others),
    };
    table(&["", ""], rows) + "<h3>Keys that are not the KC705's</h3>\n" + &keys
}

fn facts(setup: &Setup) -> Vec<(&'static str, String)> {
    let Scenario { pll, tdc, firmware, laser, spad, estimator, target, ambient, .. } =
        &setup.scenario;
    let cycle_ns = setup.cycle().fs() as f64 / 1e6;
    let delays = &setup.params.tdc.delays;
    let part = match pll.part {
        Part::Kintex7 => "Kintex-7, speed grade -2",
        Part::Ecp5 => "ECP5",
    };
    let cycles = setup.params.estimator_cycles();
    let network = if estimator.kind == FirmwareEstimator::Network {
        format!("network of {} neurons", setup.params.depth_estimator.neurons())
    } else {
        estimator.kind.module().replace('_', " ")
    };
    let bin_mm = tdc.bin_ps * 1e-9 * LIGHT_M_S / 2.0;
    let period_ns = setup.laser_period() as f64 * cycle_ns;
    let frame_ms = (setup.frame_cycles(setup.laser_period()) + 1) as f64 * cycle_ns / 1e6;
    vec![
        ("part", part.to_owned()),
        (
            "clocks",
            format!(
                "clk_sys {} MHz, clk_laser {} MHz, from {} MHz",
                short(pll.clk_sys_mhz()),
                short(2.0 * pll.clk_sys_mhz()),
                short(pll.input_hz as f64 / 1e6)
            ),
        ),
        (
            "bins",
            format!(
                "{} of {} ps, {} mm each; bin 0 begins at {} ps",
                tdc.bins,
                short(tdc.bin_ps),
                short(bin_mm),
                short(tdc.first_bin_ps)
            ),
        ),
        ("range", range_m(setup)),
        (
            "carry chain",
            format!(
                "{}: {} taps over {} ns",
                tdc.profile,
                delays.taps(),
                short(delays.span().fs() as f64 / 1e6)
            ),
        ),
        (
            "window of a shot",
            format!(
                "{} ns, {} cycles",
                short(cycle_ns * f64::from(1 << tdc.coarse_bits)),
                1u32 << tdc.coarse_bits
            ),
        ),
        (
            "laser",
            format!(
                "{} nm, {} mW on average, pulses of sigma {} ps every {} ns",
                short(laser.wavelength_nm),
                short(laser.average_power_w * 1e3),
                short(setup.budget.pulse.sigma_ps()),
                short(period_ns)
            ),
        ),
        (
            "SPADs on the TDC",
            format!(
                "{} of {}, detection probability {} %, {} Hz dark counts",
                spad.on_tdc,
                spad.count,
                short(spad.pdp * 100.0),
                short(setup.dark.one_hz())
            ),
        ),
        (
            "frame",
            format!(
                "{} shots in {} ms, {}; words of {} bits",
                firmware.shots_per_frame,
                short(frame_ms),
                frame_rate(setup),
                firmware.count_bits
            ),
        ),
        (
            "estimator",
            format!("{network}; {cycles} cycles, {} us", short(cycles as f64 * cycle_ns / 1e3)),
        ),
        (
            "scene of the frame below",
            format!(
                "{} m, reflectance {}, {} W/m^2/nm of ambient light",
                short(target.distance_m),
                short(target.reflectance),
                short(ambient.irradiance_w_m2_nm)
            ),
        ),
    ]
}

/// Keys with another value than by default: key, value, unit, default.
fn others(scenario: &Scenario) -> Vec<[String; 4]> {
    let of = |scenario: &Scenario| serde_json::to_value(scenario).unwrap_or(Value::Null);
    let (own, usual, schema) = (of(scenario), of(&Scenario::default()), schema());
    let mut rows = Vec::new();
    for (table, keys) in own.as_object().into_iter().flatten() {
        let name = schema.pointer(&format!("/properties/{table}/$ref")).and_then(Value::as_str);
        let of_table = name.and_then(|name| schema.pointer(name.trim_start_matches('#')));
        for (key, value) in keys.as_object().into_iter().flatten() {
            let before = &usual[table][key];
            if value == before {
                continue;
            }
            let unit = of_table.and_then(|it| it["properties"][key]["unit"].as_str()).unwrap_or("");
            let unit = if unit == "1" { "" } else { unit };
            rows.push([format!("{table}.{key}"), shown(value), unit.to_owned(), shown(before)]);
        }
    }
    rows
}

/// A value as a reader takes it in.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string(),
        Value::Object(keys) => {
            let each = keys.iter().map(|(key, value)| format!("{key} = {}", shown(value)));
            each.collect::<Vec<_>>().join("; ")
        }
        other => other.to_string(),
    }
}
