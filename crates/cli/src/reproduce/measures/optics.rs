//! Chapter 3: eye safety and specifications.

use tofsim::error::Result;
use tofsim::optics::eye_safety::accessible_emission_limit_j;

use crate::reproduce::measured::Measured;
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Wavelength of the laser [nm].
const LASER_NM: f64 = 940.0;

pub(super) fn emission_limits(_: &Study) -> Result<Measured> {
    let limit = |exposure_s, nm| accessible_emission_limit_j(exposure_s, nm).unwrap_or(f64::NAN);
    let mut values = Values::default();
    // C4 is 1 at 700 nm.
    values.put("c4", limit(1.0, LASER_NM) / limit(1.0, 700.0));
    for (name, exposure_s) in [("of_1_ps", 1e-12), ("of_1_ns", 1e-9), ("of_1_s", 1.0)] {
        values.put(name, limit(exposure_s, LASER_NM));
    }
    Ok(values.into())
}

pub(super) fn eye_safety(study: &Study) -> Result<Measured> {
    let exposure = study.ideal()?.exposure_at_the_optics_rate();
    let mut values = Values::default();
    values.put("limit_w", exposure.limit_w.unwrap_or(f64::NAN));
    values.put("average_w", exposure.average_w);
    values.put("exposure_s", exposure.exposure_s);
    Ok(values.into())
}

pub(super) fn specifications(study: &Study) -> Result<Measured> {
    let mut values = Values::of(&study.ideal()?.scenario);
    let lit = study.setup("kc705", &["ambient.illuminance_klux=14"])?.scenario;
    values.put("passband_of_14_klux", lit.ambient.irradiance_w_m2_nm);
    Ok(values.into())
}
