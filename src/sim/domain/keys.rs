//! The keys of a network's domain: those that decide how the histograms of a frame are distributed. The laser's rate is
//! none of them: in MODE 0 every shot begins with a reset.

use crate::optics::dark::STATED_AT_C;
use crate::scenario::drift::REFERENCE_C;
use crate::scenario::effects::Effect;

pub const CHAIN: &str = "tdc.profile";
pub const CALIBRATION: &str = "tdc.calibration";
pub const DARK_RATE: &str = "spad.dark_rate_hz";
const TEMPERATURE: &str = "spad.temperature_c";
const DOUBLING: &str = "spad.dark_doubling_c";
const ROW_OUTPUTS: &str = "spad.row_outputs";
const DIE: &str = "tdc.temperature_c";
const SUPPLY: &str = "tdc.supply_mv";
const DIE_THEN: &str = "tdc.calibrated_at_c";
const SUPPLY_THEN: &str = "tdc.calibrated_at_mv";
const PER_C: &str = "tdc.delay_per_c";
const PER_MV: &str = "tdc.delay_per_mv";

/// Keys that every file with a domain names.
pub const NAMED: [&str; 25] = [
    CHAIN,
    "target.distance_m",
    "target.reflectance",
    "target.length_m",
    "target.width_m",
    "ambient.model",
    "ambient.irradiance_w_m2_nm",
    "ambient.fitted_rate_hz_per_w_m2_nm",
    "laser.average_power_w",
    "laser.repetition_rate_hz",
    "laser.wavelength_nm",
    "laser.pulse_sigma_ps",
    "laser.field_of_illumination_deg",
    "lens.area_m2",
    "lens.efficiency",
    "filter.efficiency",
    "filter.sigma_nm",
    "spad.pdp",
    "spad.fill_factor",
    "spad.count",
    "spad.field_of_view_deg",
    DARK_RATE,
    "pll.jitter_rms_ps",
    "firmware.mode",
    "firmware.shots_per_frame",
];
/// Keys that a file may be silent of, because they had their defaults when it was written or are newer than it.
const SILENT: &[&str] = &[
    CALIBRATION,
    "tdc.decoder",
    "spad.dark_file",
    "spad.on_tdc",
    TEMPERATURE,
    DOUBLING,
    "spad.dark_spread",
    ROW_OUTPUTS,
    "tdc.bin_ps",
    "tdc.first_bin_ps",
    DIE,
    SUPPLY,
    DIE_THEN,
    SUPPLY_THEN,
    PER_C,
    PER_MV,
    // What the dividers come to, which no key of a scenario's file says [MHz].
    "pll.clk_sys_mhz",
];
/// Effects that move no histogram of a network's domain, beside those whose keys are named above: its frames are whole,
/// in MODE 0, under one scene.
const OTHER_EFFECTS: [Effect; 7] = [
    Effect::HeldFrame,
    Effect::PassiveRecharge,
    Effect::ControlChanges,
    Effect::ChangingConditions,
    Effect::Crosstalk,
    Effect::ListedShots,
    Effect::ListedHistogram,
];
/// Keys by which a chain drifts from its calibration.
pub const DRIFT: [&str; 6] = [DIE, SUPPLY, DIE_THEN, SUPPLY_THEN, PER_C, PER_MV];
/// Keys that decide nothing while all of others have a reference value: such a key, the others, and the value.
pub const DEPENDENT: [(&str, &[&str], f64); 4] = [
    // Outputs that are not on the TDC come to it by crosstalk alone.
    (ROW_OUTPUTS, &["spad.crosstalk_probability"], 0.0),
    (DOUBLING, &[TEMPERATURE], STATED_AT_C),
    (PER_C, &[DIE, DIE_THEN], REFERENCE_C),
    (PER_MV, &[SUPPLY, SUPPLY_THEN], 0.0),
];

/// Returns the keys that a file may be silent of; it means their defaults then.
pub fn silent() -> impl Iterator<Item = &'static str> {
    let effects = Effect::ALL.into_iter().filter(|effect| !OTHER_EFFECTS.contains(effect));
    let of_effects = effects.flat_map(Effect::keys).map(|key| key.name);
    let named = |key: &&str| NAMED.contains(key) || SILENT.contains(key);
    SILENT.iter().copied().chain(of_effects.filter(move |key| !named(key)))
}
