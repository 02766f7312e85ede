//! Facts of the instrument, in numbers with units.

use serde_json::Value;

use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::scenario::keys::schema;
use tofsim::scenario::{Part, Scenario};
use tofsim::sim::setup::Setup;

use crate::page::html::table;
use crate::text::table::significant;

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

fn short(number: f64) -> String {
    significant(number, 4, 6)
}

/// Returns the section with the facts, and the keys that differ from the KC705's.
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
    let keys = if others.is_empty() {
        "<p>Every key is the KC705's.</p>\n".to_owned()
    } else {
        table(&["key", "value", "unit", "KC705"], others)
    };
    table(&["", ""], rows) + "<h3>Keys that are not the KC705's</h3>\n" + &keys
}

type Facts = Vec<(&'static str, String)>;

fn facts(setup: &Setup) -> Facts {
    [converter(setup), light(setup), frame(setup)].concat()
}

/// Part, clocks, bins and carry chain.
fn converter(setup: &Setup) -> Facts {
    let Scenario { pll, tdc, .. } = &setup.scenario;
    let part = match pll.part {
        Part::Kintex7 => "Kintex-7, speed grade -2",
        Part::Ecp5 => "ECP5",
    };
    let (sys_mhz, input_mhz) = (pll.clk_sys_mhz(), short(pll.input_hz as f64 / 1e6));
    let [sys, laser] = [sys_mhz, 2.0 * sys_mhz].map(short);
    let bin_mm = short(tdc.bin_ps * 1e-9 * LIGHT_M_S / 2.0);
    let (bins, bin_ps, first_ps) = (tdc.bins, short(tdc.bin_ps), short(tdc.first_bin_ps));
    let (taps, delays) = (setup.params.tdc.delays.taps(), &setup.params.tdc.delays);
    let span_ns = short(delays.span().fs() as f64 / 1e6);
    let cycles = 1u32 << tdc.coarse_bits;
    let window_ns = short(cycle_ns(setup) * f64::from(cycles));
    vec![
        ("part", part.to_owned()),
        ("clocks", format!("clk_sys {sys} MHz, clk_laser {laser} MHz, from {input_mhz} MHz")),
        ("bins", format!("{bins} of {bin_ps} ps, {bin_mm} mm each; bin 0 begins at {first_ps} ps")),
        ("range", range_m(setup)),
        ("carry chain", format!("{}: {taps} taps over {span_ns} ns", tdc.profile)),
        ("window of a shot", format!("{window_ns} ns, {cycles} cycles")),
    ]
}

/// Laser and detector.
fn light(setup: &Setup) -> Facts {
    let Scenario { laser, spad, .. } = &setup.scenario;
    let (wavelength_nm, power_mw) =
        (short(laser.wavelength_nm), short(laser.average_power_w * 1e3));
    let sigma_ps = short(setup.budget.pulse.sigma_ps());
    let period_ns = short(setup.laser_period() as f64 * cycle_ns(setup));
    let (pdp, dark_hz) = (short(spad.pdp * 100.0), short(setup.dark.one_hz()));
    let (on_tdc, count) = (spad.on_tdc, spad.count);
    vec![
        (
            "laser",
            format!(
                "{wavelength_nm} nm, {power_mw} mW on average, pulses of sigma {sigma_ps} ps every {period_ns} ns"
            ),
        ),
        (
            "SPADs on the TDC",
            format!("{on_tdc} of {count}, detection probability {pdp} %, {dark_hz} Hz dark counts"),
        ),
    ]
}

/// Frame, estimator and scene.
fn frame(setup: &Setup) -> Facts {
    let Scenario { firmware, estimator, target, ambient, .. } = &setup.scenario;
    let name = if estimator.kind == FirmwareEstimator::Network {
        format!("network of {} neurons", setup.params.estimators.depth_estimator.neurons())
    } else {
        estimator.kind.module().replace('_', " ")
    };
    let cycles = setup.params.estimator_cycles();
    let us = short(cycles as f64 * cycle_ns(setup) / 1e3);
    let frame_cycles = (setup.frame_cycles(setup.laser_period()) + 1) as f64;
    let (frame_ms, rate) = (short(frame_cycles * cycle_ns(setup) / 1e6), frame_rate(setup));
    let (shots, bits) = (firmware.shots_per_frame, firmware.count_bits);
    let (distance_m, reflectance) = (short(target.distance_m), short(target.reflectance));
    let irradiance = short(ambient.irradiance_w_m2_nm);
    vec![
        ("frame", format!("{shots} shots in {frame_ms} ms, {rate}; words of {bits} bits")),
        ("estimator", format!("{name}; {cycles} cycles, {us} us")),
        (
            "scene of the frame below",
            format!(
                "{distance_m} m, reflectance {reflectance}, {irradiance} W/m^2/nm of ambient light"
            ),
        ),
    ]
}

fn cycle_ns(setup: &Setup) -> f64 {
    setup.cycle().fs() as f64 / 1e6
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
