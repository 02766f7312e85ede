//! Keys that decide how the histograms of a frame are distributed, and what files say of them that are older.

use crate::optics::dark::STATED_AT_C;
use crate::scenario::drift::REFERENCE_C;

use super::scene::{OFFSET_X, OFFSET_Y, PATCH, RAIN, TILT, VISIBILITY, YAW};

/// Keys of the scenario that decide how the histograms of a frame are distributed. The laser's rate is
/// none of them: in MODE 0 every shot begins with a reset.
pub const KEYS: [&str; 54] = [
    "target.distance_m",
    "target.reflectance",
    "target.length_m",
    "target.width_m",
    TILT,
    YAW,
    OFFSET_X,
    OFFSET_Y,
    PATCH,
    VISIBILITY,
    RAIN,
    "ambient.model",
    "ambient.irradiance_w_m2_nm",
    "ambient.fitted_rate_hz_per_w_m2_nm",
    "laser.average_power_w",
    "laser.repetition_rate_hz",
    "laser.wavelength_nm",
    "laser.pulse_sigma_ps",
    TAIL,
    DELAY,
    TIMING,
    ENERGY,
    "laser.field_of_illumination_deg",
    "lens.area_m2",
    "lens.efficiency",
    "filter.efficiency",
    "filter.sigma_nm",
    "spad.pdp",
    "spad.fill_factor",
    "spad.count",
    ON_TDC,
    "spad.field_of_view_deg",
    "spad.dark_rate_hz",
    TEMPERATURE,
    DOUBLING,
    SPREAD,
    AFTERPULSES,
    ROW_OUTPUTS,
    PULSE,
    PULSE_GAP,
    BIN,
    FIRST_BIN,
    DIE,
    SUPPLY,
    DIE_THEN,
    SUPPLY_THEN,
    PER_C,
    PER_MV,
    RECALIBRATED,
    WINDOW,
    CLK_SYS,
    "pll.jitter_rms_ps",
    "firmware.mode",
    SHOTS,
];
const TAIL: &str = "laser.pulse_tail_ps";
const DELAY: &str = "laser.delay_ps";
const TIMING: &str = "laser.timing_jitter_ps";
const ENERGY: &str = "laser.energy_jitter";
pub const PULSE_FILE: &str = "laser.pulse_file";
const ON_TDC: &str = "spad.on_tdc";
const TEMPERATURE: &str = "spad.temperature_c";
const DOUBLING: &str = "spad.dark_doubling_c";
const SPREAD: &str = "spad.dark_spread";
const AFTERPULSES: &str = "spad.afterpulse_probability";
const ROW_OUTPUTS: &str = "spad.row_outputs";
const CROSSTALK: &str = "spad.crosstalk_probability";
const PULSE: &str = "spad.pulse_ns";
const PULSE_GAP: &str = "spad.pulse_gap_ns";
pub const DARK_FILE: &str = "spad.dark_file";
const BIN: &str = "tdc.bin_ps";
const FIRST_BIN: &str = "tdc.first_bin_ps";
const DIE: &str = "tdc.temperature_c";
const SUPPLY: &str = "tdc.supply_mv";
const DIE_THEN: &str = "tdc.calibrated_at_c";
const SUPPLY_THEN: &str = "tdc.calibrated_at_mv";
const PER_C: &str = "tdc.delay_per_c";
const PER_MV: &str = "tdc.delay_per_mv";
const RECALIBRATED: &str = "tdc.recalibrate_frames";
const WINDOW: &str = "tdc.setup_window_ps";
const SHOTS: &str = "firmware.shots_per_frame";
/// What a drift of the chain is of.
pub const OF_DRIFT: [&str; 6] = [DIE, SUPPLY, DIE_THEN, SUPPLY_THEN, PER_C, PER_MV];
/// Keys that say what follows from others, and decide nothing while these are all at a reference.
pub const FOLLOWING: [(&str, &[&str], f64); 4] = [
    // Outputs that are not on the TDC come to it by crosstalk alone.
    (ROW_OUTPUTS, &[CROSSTALK], 0.0),
    (DOUBLING, &[TEMPERATURE], STATED_AT_C),
    (PER_C, &[DIE, DIE_THEN], REFERENCE_C),
    (PER_MV, &[SUPPLY, SUPPLY_THEN], 0.0),
];
/// What the dividers come to, which no key of a file says [MHz].
const CLK_SYS: &str = "pll.clk_sys_mhz";
/// Keys that older files do not have, and the only value that there was.
pub const LATER: [(&str, f64); 30] = [
    (TILT, 0.0),
    (YAW, 0.0),
    (OFFSET_X, 0.0),
    (OFFSET_Y, 0.0),
    (PATCH, 0.0),
    (VISIBILITY, 0.0),
    (RAIN, 0.0),
    (TAIL, 0.0),
    (DELAY, 0.0),
    (TIMING, 0.0),
    (ENERGY, 0.0),
    (ON_TDC, 1.0),
    (TEMPERATURE, 20.0),
    (DOUBLING, 8.0),
    (SPREAD, 0.0),
    (AFTERPULSES, 0.0),
    (ROW_OUTPUTS, 0.0),
    (PULSE, 0.0),
    (PULSE_GAP, 0.0),
    (BIN, 25.0),
    (FIRST_BIN, 0.0),
    (DIE, 25.0),
    (SUPPLY, 0.0),
    (DIE_THEN, 25.0),
    (SUPPLY_THEN, 0.0),
    (PER_C, 0.001),
    (PER_MV, -0.001),
    (RECALIBRATED, 0.0),
    (WINDOW, 0.0),
    (CLK_SYS, 125.0),
];
