//! What the scenario's keys must be to one another.

use toml_edit::{Item, Table};

use crate::error::Result;
use crate::files::toml::Checked;

use super::model::Scenario;
use super::window::Window;

/// Frequency of the whole-cycle clock that the firmware is built for [Hz].
const CLK_125_HZ: u64 = 125_000_000;
/// Range of the PLL's oscillator, Kintex-7 speed grade -2 (DS182) [Hz].
const VCO_HZ: std::ops::RangeInclusive<u64> = 800_000_000..=1_866_000_000;

/// Checks what no single key shows.
pub fn validate(scenario: &Scenario, checked: &Checked) -> Result<()> {
    clocks(scenario, checked)?;
    stimulus(scenario, checked)?;
    control(scenario, checked)?;
    dark_frames(scenario, checked)
}

fn clocks(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let pll = &scenario.pll;
    let vco = pll.input_hz * pll.multiply / pll.divide;
    if !VCO_HZ.contains(&vco) {
        let expected = format!("the VCO would run at {vco} Hz, expected 800 to 1866 MHz");
        return Err(checked.fault("pll.multiply", expected).into());
    }
    if pll.input_hz * pll.multiply != CLK_125_HZ * pll.divide * pll.output_divide {
        let expected = format!(
            "clk_125 would run at {} Hz, expected exactly {CLK_125_HZ}",
            vco as f64 / pll.output_divide as f64
        );
        return Err(checked.fault("pll.output_divide", expected).into());
    }
    if !pll.output_divide.is_multiple_of(2) {
        let expected = "expected an even number: clk_250 has half of it";
        return Err(checked.fault("pll.output_divide", expected).into());
    }
    Ok(())
}

fn stimulus(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let stimulus = &scenario.stimulus;
    let given = [
        ("stimulus.photons", &stimulus.photons),
        ("stimulus.codes", &stimulus.codes),
        ("stimulus.histogram", &stimulus.histogram),
    ];
    let mut given = given.iter().filter(|(_, file)| file.is_some());
    if let (Some((first, _)), Some((second, _))) = (given.next(), given.next()) {
        let expected = format!("expected one stimulus only, {first} is given too");
        return Err(checked.fault(second, expected).into());
    }
    if scenario.report.tdc && (stimulus.codes.is_some() || stimulus.histogram.is_some()) {
        let expected = "the TDC takes no part with preloaded codes or a preloaded histogram";
        return Err(checked.fault("report.tdc", expected).into());
    }
    Ok(())
}

/// Checks the texts that stand for windows in a table of values, before they are read.
pub fn windows(values: &Table, checked: &Checked) -> Result<()> {
    let windows = values.get("report").and_then(|report| report.get("windows"));
    for (k, text) in windows.and_then(Item::as_array).into_iter().flatten().enumerate() {
        let fault = |expected: String| checked.fault(&format!("report.windows.{k}"), expected);
        text.as_str().map_or(Ok(()), |text| text.parse::<Window>().map(drop)).map_err(fault)?;
    }
    Ok(())
}

fn control(scenario: &Scenario, checked: &Checked) -> Result<()> {
    for (k, pair) in scenario.control.windows(2).enumerate() {
        if pair[1].at_us < pair[0].at_us {
            let expected = format!("expected {} or later: changes in order", pair[0].at_us);
            return Err(checked.fault(&format!("control.{}.at_us", k + 1), expected).into());
        }
    }
    Ok(())
}

/// What pairs of a dark and a lit frame cannot be made of.
fn dark_frames(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let (firmware, stimulus) = (&scenario.firmware, &scenario.stimulus);
    if !firmware.dark_frames {
        return Ok(());
    }
    let fault = |key: &str, value: &dyn std::fmt::Display, expected: &str| {
        let expected = format!("{expected} with firmware.dark_frames (--estimator subtraction)");
        Err(checked.fault(key, expected).value(value).into())
    };
    if !firmware.shots_per_frame.is_multiple_of(2) {
        let expected = "expected an even number, half of it for the dark frame,";
        return fault("firmware.shots_per_frame", &firmware.shots_per_frame, expected);
    }
    if !firmware.laser_en {
        let expected = "expected true, for the lit frames,";
        return fault("firmware.laser_en", &firmware.laser_en, expected);
    }
    let replaced = [
        (
            "stimulus.codes",
            &stimulus.codes,
            "expected light or photons, codes come without a laser,",
        ),
        (
            "stimulus.histogram",
            &stimulus.histogram,
            "expected light or photons, it has one frame only,",
        ),
    ];
    for (key, file, expected) in replaced {
        if let Some(file) = file {
            return fault(key, file, expected);
        }
    }
    for (k, change) in scenario.control.iter().enumerate() {
        if let Some(laser_en) = change.laser_en {
            let expected = "expected no change of the laser, which changes from frame to frame";
            return fault(&format!("control.{k}.laser_en"), &laser_en, expected);
        }
    }
    Ok(())
}
