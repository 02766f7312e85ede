//! Checks of the scenario that involve more than one key.

mod array;
mod clocks;
mod cover;
mod target;

use std::fmt::Display;

use toml_edit::{Item, Table};

use crate::error::Result;
use crate::files::toml::Checked;
use crate::firmware::tdc_decoder::TimeScale;
use crate::kernel::Time;

use super::model::{Control, Firmware, Scenario, Spad, Stimulus, Tdc, TdcCalibration};
use super::window::Window;
use super::wiring::ON_TDC;

/// Largest number of decoder time units per period of `clk_sys`, because times and ages have 42 bits.
const MOST_UNITS: u64 = 1 << 29;

/// Checks all constraints that involve more than one key.
///
/// # Errors
/// The first key that violates a constraint, with its value and what was expected.
pub fn validate(scenario: &Scenario, checked: &Checked) -> Result<()> {
    clocks::check(&scenario.pll, checked)?;
    bins(scenario, checked)?;
    calibration(scenario, checked)?;
    counts(scenario, checked)?;
    stimulus(scenario, checked)?;
    spads(scenario, checked)?;
    laser(scenario, checked)?;
    target::check(&scenario.target, checked)?;
    array::check(scenario, checked)?;
    cover::check(scenario, checked)?;
    control(scenario, checked)?;
    dark_frames(scenario, checked)
}

fn ensure(holds: bool, checked: &Checked, key: &str, expected: impl Display) -> Result<()> {
    if holds { Ok(()) } else { Err(checked.fault(key, expected).into()) }
}

/// Checks that the shot window contains the first bin, and that the decoder can represent its times.
fn bins(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let Tdc { bins, bin_ps, first_bin_ps, coarse_bits, .. } = scenario.tdc;
    if !bins.is_power_of_two() {
        let (below, above) = (bins.next_power_of_two() / 2, bins.next_power_of_two());
        let expected = format!("expected a power of two, such as {below} or {above}");
        return Err(checked.fault("tdc.bins", expected).value(bins).into());
    }
    let cycle = scenario.pll.params().cycle();
    let window_ps = cycle.fs() as f64 / 1e3 * f64::from(1 << coarse_bits);
    let window = format!("the window that {coarse_bits} bits count (tdc.coarse_bits)");
    let fault =
        |key, value: f64, expected: String| Err(checked.fault(key, expected).value(value).into());
    if bin_ps > window_ps {
        let expected = format!("expected {window_ps} ps at most, {window}");
        return fault("tdc.bin_ps", bin_ps, expected);
    }
    let most_ps = window_ps - bin_ps;
    if first_bin_ps > most_ps {
        let expected = format!("expected {most_ps} ps at most, a bin less than {window}");
        return fault("tdc.first_bin_ps", first_bin_ps, expected);
    }
    let [bin, first] = [bin_ps, first_bin_ps].map(Time::from_ps_f64);
    let holds =
        |bits: &u32| TimeScale::new(cycle, bin, first, *bits, bins as usize).cycle() <= MOST_UNITS;
    match (1..=coarse_bits).rev().find(holds) {
        Some(most) if most < coarse_bits => {
            let expected = format!(
                "expected {most} at most: with such bins and so long a period of clk_sys the decoder's \
                 times have no more bits"
            );
            fault("tdc.coarse_bits", coarse_bits.into(), expected)
        }
        _ => Ok(()),
    }
}

/// Checks that the TDC's conditions are given once, and that a self-calibrating firmware has a TDC and no other
/// calibration.
fn calibration(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let (tdc, stimulus) = (&scenario.tdc, &scenario.stimulus);
    let usual = Tdc::default();
    for (key, value, usual) in [
        ("tdc.temperature_c", tdc.temperature_c, usual.temperature_c),
        ("tdc.supply_mv", tdc.supply_mv, usual.supply_mv),
    ] {
        if tdc.conditions.is_some() && value != usual {
            let expected = format!("expected {usual}: tdc.conditions sets it");
            return Err(checked.fault(key, expected).value(value).into());
        }
    }
    if tdc.recalibrate_frames == 0 {
        return Ok(());
    }
    let expected = "expected nothing: the firmware calibrates itself (tdc.recalibrate_frames)";
    for (key, is_told) in [
        ("tdc.calibration", tdc.calibration != TdcCalibration::True),
        ("tdc.calibrated_at_c", tdc.calibrated_at_c.is_some()),
        ("tdc.calibrated_at_mv", tdc.calibrated_at_mv.is_some()),
        ("stimulus.codes", stimulus.codes.is_some()),
        ("stimulus.histogram", stimulus.histogram.is_some()),
    ] {
        ensure(!is_told, checked, key, expected)?;
    }
    Ok(())
}

/// Checks that a histogram bin can count all shots of a frame.
fn counts(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let Firmware { count_bits, shots_per_frame: shots, .. } = scenario.firmware;
    let (most, enough) = ((1u64 << count_bits) - 1, u64::BITS - shots.leading_zeros());
    let expected = format!(
        "expected {most} at most, what a word of {count_bits} bits holds (firmware.count_bits; {enough} would do)"
    );
    let fault = checked.fault("firmware.shots_per_frame", expected).value(shots);
    if shots > most { Err(fault.into()) } else { Ok(()) }
}

fn stimulus(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let Stimulus { photons, codes, histogram } = &scenario.stimulus;
    let given = [
        ("stimulus.photons", photons),
        ("stimulus.codes", codes),
        ("stimulus.histogram", histogram),
    ];
    let mut given = given.iter().filter(|(_, file)| file.is_some());
    if let (Some((first, _)), Some((second, _))) = (given.next(), given.next()) {
        let expected = format!("expected one stimulus only, {first} is given too");
        return Err(checked.fault(second, expected).into());
    }
    let tdc_takes_part = codes.is_none() && histogram.is_none();
    let expected = "the TDC takes no part with preloaded codes or a preloaded histogram";
    ensure(!scenario.report.tdc || tdc_takes_part, checked, "report.tdc", expected)
}

fn spads(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let (on_tdc, count) = (scenario.spad.on_tdc, scenario.spad.count);
    let afterpulses = scenario.spad.afterpulse_probability;
    if afterpulses >= 1.0 {
        let expected = "expected less than 1: with 1 the afterpulses of an avalanche never die out";
        return Err(checked
            .fault("spad.afterpulse_probability", expected)
            .value(afterpulses)
            .into());
    }
    let fault = |expected: &str| {
        Err(checked.fault("spad.on_tdc", format!("expected {expected}")).value(on_tdc).into())
    };
    row(&scenario.spad, checked)?;
    if on_tdc > count {
        return fault(&format!("{count} at most, as many as share the light (spad.count)"));
    }
    let Some(_) = scenario.stimulus.photons else { return Ok(()) };
    if on_tdc > 1 {
        return fault("1: the photons of a list (stimulus.photons) are those of one");
    }
    let row = scenario.spad.row_outputs;
    let expected = "expected 0: the photons of a list (stimulus.photons) are those of one SPAD";
    if row > 0 {
        Err(checked.fault("spad.row_outputs", expected).value(row).into())
    } else {
        Ok(())
    }
}

/// Checks that the simulated row contains the outputs on the TDC, that it is not larger than the number of
/// illuminated SPADs, and that its dark rates are given once.
fn row(spad: &Spad, checked: &Checked) -> Result<()> {
    let &Spad { on_tdc, count, row_outputs: row, dark_spread, .. } = spad;
    let refused = match row {
        0 => None,
        _ if row as usize <= ON_TDC => {
            Some(format!("{} or more, so that output {ON_TDC} is in the row", ON_TDC + 1))
        }
        _ if row < on_tdc => {
            Some(format!("{on_tdc} or more, as many as are on the TDC (spad.on_tdc)"))
        }
        _ if row > count => {
            Some(format!("{count} at most, as many as share the light (spad.count)"))
        }
        _ => None,
    };
    if let Some(expected) = refused {
        let expected = format!("expected 0, or {expected}");
        return Err(checked.fault("spad.row_outputs", expected).value(row).into());
    }
    if spad.dark_file.is_some() && dark_spread > 0.0 {
        let expected = "expected 0: spad.dark_file says what the rates are";
        return Err(checked.fault("spad.dark_spread", expected).value(dark_spread).into());
    }
    Ok(())
}

/// Checks that one pulse is given, and that every `laser_freq` selects an entry of `firmware.laser_periods`.
fn laser(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let (firmware, laser) = (&scenario.firmware, &scenario.laser);
    if laser.pulse_file.is_some() && laser.pulse_tail_ps > 0.0 {
        let expected = "expected 0: laser.pulse_file says what the pulse is";
        let fault = checked.fault("laser.pulse_tail_ps", expected).value(laser.pulse_tail_ps);
        return Err(fault.into());
    }
    let last = firmware.laser_periods.len() as u64 - 1;
    let own = ("firmware.laser_freq".to_owned(), Some(firmware.laser_freq));
    let change =
        |(k, change): (usize, &Control)| (format!("control.{k}.laser_freq"), change.laser_freq);
    let changes = scenario.control.iter().enumerate().map(change);
    for (key, code) in [own].into_iter().chain(changes) {
        if let Some(code) = code.filter(|code| *code > last) {
            let expected = format!("expected {last} at most, the last of firmware.laser_periods");
            return Err(checked.fault(&key, expected).value(code).into());
        }
    }
    Ok(())
}

/// Checks the text of each waveform window, before the scenario is deserialized.
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
        let expected = format!("expected {} or later: changes in order", pair[0].at_us);
        let key = format!("control.{}.at_us", k + 1);
        ensure(pair[1].at_us >= pair[0].at_us, checked, &key, expected)?;
    }
    Ok(())
}

/// Checks that dark and lit frames can alternate.
fn dark_frames(scenario: &Scenario, checked: &Checked) -> Result<()> {
    let (Firmware { shots_per_frame, laser_en, .. }, stimulus) =
        (&scenario.firmware, &scenario.stimulus);
    if !scenario.firmware.dark_frames {
        return Ok(());
    }
    let fault = |key: &str, value: &dyn Display, expected: &str| {
        let expected = format!("{expected} with firmware.dark_frames (--estimator subtraction)");
        Err(checked.fault(key, expected).value(value).into())
    };
    if !shots_per_frame.is_multiple_of(2) {
        let expected = "expected an even number, half of it for the dark frame,";
        return fault("firmware.shots_per_frame", shots_per_frame, expected);
    }
    if !laser_en {
        return fault("firmware.laser_en", laser_en, "expected true, for the lit frames,");
    }
    if let Some(file) = &stimulus.codes {
        let expected = "expected light or photons, codes come without a laser,";
        return fault("stimulus.codes", file, expected);
    }
    if let Some(file) = &stimulus.histogram {
        let expected = "expected light or photons, it has one frame only,";
        return fault("stimulus.histogram", file, expected);
    }
    for (k, change) in scenario.control.iter().enumerate() {
        if let Some(laser_en) = change.laser_en {
            let expected = "expected no change of the laser, which changes from frame to frame";
            return fault(&format!("control.{k}.laser_en"), &laser_en, expected);
        }
    }
    Ok(())
}
