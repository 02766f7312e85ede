//! Chapter 3: eye safety, specifications.

use tofsim::error::Result;
use tofsim::optics::eye_safety::accessible_emission_limit_j;

use crate::reproduce::item::{Finding, Item};
use crate::reproduce::study::Study;
use crate::reproduce::verdict::{Number, Row};

pub const ITEMS: [Item; 3] = [
    Item::made("table-3.1", "Accessible emission limits of Class 1", limits),
    Item::made("table-3.2", "Specifications of the system", specifications),
    Item::made("eq-3.3", "Eye safety: the laser's average power", eye_safety),
];

/// The laser's wavelength [nm].
const LASER_NM: f64 = 940.0;

fn limits(_: &Study) -> Result<Finding> {
    let limit = |exposure_s, nm| accessible_emission_limit_j(exposure_s, nm).unwrap_or(f64::NAN);
    // C4 is 1 at 700 nm.
    let c4 = limit(1.0, LASER_NM) / limit(1.0, 700.0);
    let rows = [
        Row::numbers("C4 at 940 nm", "", Number::new(3.02, 2), Number::new(c4, 4)),
        Row::numbers(
            "from 1e-13 to 1e-11 s",
            "nJ",
            Number::new(38.0, 0),
            Number::new(1e9 * limit(1e-12, LASER_NM), 2),
        ),
        Row::numbers(
            "up to 5e-6 s, over C4",
            "nJ",
            Number::new(77.0, 0),
            Number::new(1e9 * limit(1e-9, LASER_NM) / c4, 2),
        ),
        Row::numbers(
            "up to 10 s, over C4, at 1 s",
            "uJ",
            Number::new(700.0, 0),
            Number::new(1e6 * limit(1.0, LASER_NM) / c4, 2),
        ),
    ];
    let reason = "The raised mark at C4 is read as that of the table's footnote: C4 multiplies. Read as an exponent of -1, \
                  eq. 3.3 would come to 1.40 mW and not to its 12.77 mW.";
    Ok(Finding::of(rows).because(reason))
}

fn eye_safety(study: &Study) -> Result<Finding> {
    let setup = study.ideal()?;
    let exposure = setup.exposure_at_the_optics_rate();
    let limit_mw = 1e3 * exposure.limit_w.unwrap_or(f64::NAN);
    let average_mw = 1e3 * exposure.average_w;
    let rows = [
        Row::numbers("P_m,avg", "mW", Number::new(12.77, 2), Number::new(limit_mw, 3)),
        Row::claim(
            "P_s is lower",
            exposure.is_within() == Some(true),
            format!("{average_mw:.2} mW over {:.2} ms", 1e3 * exposure.exposure_s),
        ),
    ];
    let reason = "30,000 shots at 40 MHz. A frame at the firmware's own 20.8 MHz, and frames that repeat, are other \
                  exposures: tofsim budget has them.";
    Ok(Finding::of(rows).because(reason).shown_by("tofsim budget"))
}

fn specifications(study: &Study) -> Result<Finding> {
    let scenario = study.ideal()?.scenario;
    let klux = study.setup("kc705", &["ambient.illuminance_klux=14"])?.scenario;
    let passband = klux.ambient.irradiance_w_m2_nm;
    let (laser, spad, target) = (&scenario.laser, &scenario.spad, &scenario.target);
    let row = |what: &str, unit, thesis: (f64, usize), ours: f64| {
        Row::numbers(what, unit, Number::new(thesis.0, thesis.1), Number::new(ours, thesis.1 + 1))
    };
    let through = passband * scenario.filter.efficiency;
    let rows = [
        row("P_s", "mW", (7.36, 2), 1e3 * laser.average_power_w),
        row("wavelength", "nm", (940.0, 0), laser.wavelength_nm),
        row("f", "MHz", (40.0, 0), 1e-6 * laser.repetition_rate_hz),
        row("FOI", "deg", (21.0, 0), laser.field_of_illumination_deg),
        row("L", "cm", (26.0, 0), 1e2 * target.length_m),
        row("W", "cm", (20.0, 0), 1e2 * target.width_m),
        row("A_l", "mm^2", (95.0, 0), 1e6 * scenario.lens.area_m2),
        row("A_l of a lens of 11 mm", "mm^2", (95.0, 0), std::f64::consts::PI * 5.5 * 5.5),
        row("eta_l", "%", (80.0, 0), 1e2 * scenario.lens.efficiency),
        row("eta_f", "%", (67.0, 0), 1e2 * scenario.filter.efficiency),
        row("M", "", (40.0, 0), f64::from(spad.count)),
        row("FOV", "deg", (24.0, 0), spad.field_of_view_deg),
        row("PDP (section 4.2)", "%", (1.2, 1), 1e2 * spad.pdp),
        row("FF", "%", (25.0, 0), 1e2 * spad.fill_factor),
        row("T_D", "ns", (20.0, 0), spad.dead_time_ns),
        row("14 klux, mean over the passband", "W/m^2/nm", (0.4, 1), passband),
        row("14 klux, times the filter's peak of 67 %", "W/m^2/nm", (0.4, 1), through),
    ];
    let reason = "All but the light are the defaults of the scenario kc705. The thesis calls 14 klux of halogen light similar to \
                  0.4 W/m^2/nm (section 4.2). A black body of 2800 K by eq. 3.15 to 3.18 comes to 0.58 in the filter's \
                  passband; with the filter's peak of 67 % counted here, it is 0.39. Which of the two is meant is not said.";
    Ok(Finding::of(rows)
        .because(reason)
        .shown_by("tofsim scenario show kc705 -s ambient.illuminance_klux=14"))
}
