//! How exactly peak detection sees: Fig. 4.8 and 4.9.

use tofsim::error::Result;

use crate::reproduce::item::{Finding, Item};
use crate::reproduce::study::Study;
use crate::reproduce::tradeoffs::{Line, TradeOff, words};
use crate::reproduce::verdict::Row;

pub const ITEMS: [Item; 2] = [
    Item::made("fig-4.8", "Depth resolution over cycles, bin and laser power", adjustable),
    Item::made("fig-4.9", "Depth resolution over ambient light and reflectance", not_adjustable),
];

/// One of the distances at which resolution is worked out; the thesis does not say its own [m].
const AT_M: f64 = 0.4;

fn line(found: &TradeOff, x: &str, y: &str) -> Line {
    found.line(x, &format!("peak.{y}"), &[("target.distance_m", AT_M)])
}

/// The least and the largest value of a line.
fn ends(line: &Line) -> (f64, f64) {
    let values = || line.iter().map(|point| point.1);
    (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
}

/// Whether the bias is larger than sigma at most points of a line.
fn bias_leads(found: &TradeOff, x: &str) -> bool {
    let (bias, sd) = (line(found, x, "bias_mm"), line(found, x, "sd_mm"));
    let larger = bias.iter().zip(&sd).filter(|(bias, sd)| bias.1.abs() > sd.1).count();
    2 * larger > bias.len()
}

fn adjustable(study: &Study) -> Result<Finding> {
    let cycles = TradeOff::of(study, "fig-4-8ab")?;
    let bins = TradeOff::of(study, "fig-4-8cd")?;
    let power = TradeOff::of(study, "fig-4-8ef")?;
    let by_cycles = line(&cycles, "firmware.shots_per_frame", "root_mse_mm");
    let bias = line(&cycles, "firmware.shots_per_frame", "bias_mm");
    let (least, largest) = ends(&by_cycles);
    let (least_bias, largest_bias) = ends(&bias);
    let sigma = line(&bins, "tdc.bin_ps", "sd_mm");
    let jumps = sigma.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).fold(0.0, f64::max);
    let rows = [
        Row::claim(
            "root MSE is unchanged with the cycles [mm]",
            largest - least < 0.15 * largest,
            words(&by_cycles, 1),
        ),
        Row::claim(
            "so is the bias [mm]",
            largest_bias - least_bias < 0.15 * largest_bias,
            words(&bias, 1),
        ),
        Row::claim("sigma jumps with large bins [mm]", jumps > 1.0, words(&sigma, 1)),
        Row::claim(
            "the bias makes the root MSE, not sigma",
            bias_leads(&cycles, "firmware.shots_per_frame")
                && bias_leads(&power, "laser.average_power_w"),
            format!("bias {} mm over the cycles", words(&bias, 1)),
        ),
    ];
    let reason = "The thesis does not say at which distance; here 0.4 m, and its pictures are of 0.2, 0.4 and 0.6 m. Sigma falls \
                  with the cycles, where the thesis sees it rise by little.";
    let mut finding = Finding::of(rows).because(reason);
    for found in [&cycles, &bins, &power] {
        finding = found.shown_in(finding)?;
    }
    Ok(finding)
}

fn not_adjustable(study: &Study) -> Result<Finding> {
    let light = TradeOff::of(study, "fig-4-9ab")?;
    let targets = TradeOff::of(study, "fig-4-9cd")?;
    let bias = line(&light, "ambient.irradiance_w_m2_nm", "bias_mm");
    let by_target = line(&targets, "target.reflectance", "bias_mm");
    let (least, largest) = ends(&by_target);
    let rows = [
        Row::claim(
            "with ambient light the bias makes the root MSE",
            bias_leads(&light, "ambient.irradiance_w_m2_nm"),
            format!("bias {} mm", words(&bias, 1)),
        ),
        Row::claim(
            "reflectance moves the bias, as the order of photons has it [mm]",
            largest - least > 3.0,
            words(&by_target, 1),
        ),
    ];
    let reason = "The thesis's straight line (eq. 5.1, 5.2) takes a mean shift out: a bright target's echo is early, a dark one's \
                  late beside it.";
    targets.shown_in(light.shown_in(Finding::of(rows).because(reason))?)
}
